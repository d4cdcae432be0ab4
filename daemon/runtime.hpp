// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/backend_thread.hpp"
#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/event_log.hpp"
#include "daemon/odometry_thread.hpp"
#include "daemon/receive_thread.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::daemon {

struct RuntimeOptions {
  /// The source is a capture: nothing is dropped, the source waits for odometry, odometry for the
  /// back end.
  bool lossless = false;
  std::filesystem::path session_file;  ///< Empty: no session is kept.
  std::string source_name;             ///< For status: "udp:7502", "pcap:drive.pcap".
  /// Where everyone posts events; never null.
  std::shared_ptr<EventLog> events = std::make_shared<EventLog>();
};

/// What fills a queue.
struct QueueStatus {
  std::size_t size = 0;
  std::size_t capacity = 0;
  std::uint64_t dropped = 0;
};

/// Everything there is to tell at one moment. Value type.
struct RuntimeStatus {
  std::shared_ptr<const Snapshot> snapshot;  ///< Never null.
  std::shared_ptr<const MapState> map;       ///< Never null.
  SourceState source = SourceState::kWaiting;
  std::string source_error;
  std::uint64_t packets_received = 0;
  std::uint64_t kernel_drops = 0;
  QueueStatus packets;
  QueueStatus keyframes;
};

/// The pipeline's threads (receive, odometry, backend, worker): the only place where threads start
/// and stop. The caller's thread is the fifth, `main`. Public members are thread-safe after
/// start().
class Runtime {
 public:
  /// @throws InputError when the session file cannot be created.
  Runtime(const SensorInfo& info, const Config& config, std::unique_ptr<PacketSource> source,
          RuntimeOptions options);
  /// Stops.
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  /// Starts the threads; `on_scan` is called on the odometry thread. Call once.
  void start(ScanListener on_scan = {});
  /// Ends the source, lets every stage finish what is queued, and joins the threads. From the
  /// thread that called start().
  void stop();

  [[nodiscard]] RuntimeStatus status() const;
  [[nodiscard]] std::shared_ptr<const Snapshot> snapshot() const {
    return crossings_.snapshot.load();
  }
  void post(Command command) { crossings_.commands.post(std::move(command)); }
  /// Runs a job on the worker thread. False when too many are waiting. From one thread only.
  [[nodiscard]] bool submit(Job job) { return crossings_.jobs.try_push(job); }

  /// Every thread has given a sign of life within `limit_ns`, or has ended as it should.
  [[nodiscard]] bool alive(std::int64_t limit_ns) const;
  /// Why a thread ended as it should not; empty while all is well.
  [[nodiscard]] std::string fault() const;

  [[nodiscard]] const SensorInfo& info() const { return info_; }
  [[nodiscard]] const RuntimeOptions& options() const { return options_; }
  [[nodiscard]] EventLog& events() const { return *options_.events; }

 private:
  void spawn(const char* name, std::function<void()> body);
  void work();

  const SensorInfo info_;
  const Config config_;
  const RuntimeOptions options_;
  const std::unique_ptr<PacketSource> source_;

  Crossings crossings_;
  Heartbeat receive_heartbeat_;
  Heartbeat odometry_heartbeat_;
  Heartbeat backend_heartbeat_;
  Heartbeat worker_heartbeat_;
  mutable std::mutex fault_mutex_;
  std::string fault_;  ///< Guarded by fault_mutex_.

  std::unique_ptr<ReceiveThread> receive_;
  std::unique_ptr<OdometryThread> odometry_;
  BackendThread backend_;
  std::vector<std::thread> threads_;
};

}  // namespace glint::daemon
