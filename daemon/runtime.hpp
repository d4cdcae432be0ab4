// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/backend_thread.hpp"
#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/event_log.hpp"
#include "daemon/job_board.hpp"
#include "daemon/odometry_thread.hpp"
#include "daemon/receive_thread.hpp"
#include "daemon/session_plan.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::daemon {

/// No thread works on one thing for so long.
constexpr std::int64_t kThreadLimitNs = 10'000'000'000;

struct RuntimeOptions {
  /// The source is a capture: nothing is dropped, the source waits for odometry, odometry for the
  /// back end.
  bool lossless = false;
  SessionPlan session;
  std::string source_name;  ///< For status: "udp:7502", "pcap:drive.pcap".
  /// Makes what finds places seen before, for each map that is begun; empty: none are looked for.
  /// Called on the backend thread.
  std::function<slam::LoopSource()> loops;
  /// Where everyone posts events; never null.
  std::shared_ptr<EventLog> events = std::make_shared<EventLog>();
};

/// What fills a queue.
struct QueueStatus {
  std::size_t size = 0;
  std::size_t capacity = 0;
  std::uint64_t dropped = 0;
};

/// The latest lidar packet.
struct LastPacket {
  std::int64_t arrival_ns = 0;  ///< Steady clock; 0: none has come.
  std::uint32_t init_id = 0;    ///< 0: its format has none, or it was not looked at yet.
};

/// Long work that reports how it fares, see RunningJob. Its result; null when it was given up, an
/// exception when it failed.
using JobBody = std::function<std::optional<Json>(RunningJob& job)>;

/// Everything there is to tell at one moment. Value type.
struct RuntimeStatus {
  std::shared_ptr<const Snapshot> snapshot;  ///< Never null.
  std::shared_ptr<const MapState> map;       ///< Never null.
  SourceState source = SourceState::kWaiting;
  std::string source_error;
  std::vector<std::string> source_notices;   ///< What the source had to say at its end.
  std::shared_ptr<const SensorInfo> sensor;  ///< Null while it is not known.
  std::uint64_t packets_received = 0;
  std::uint64_t kernel_drops = 0;
  std::uint64_t foreign = 0;  ///< Datagrams of other senders.
  QueueStatus packets;
  QueueStatus keyframes;
  std::vector<JobReport> jobs;  ///< The latest ones, the last begun first.
};

/// The pipeline's threads (receive, odometry, backend, worker, jobs): the only place where threads
/// start and stop. The caller's thread is the sixth, `main`. That of jobs is not watched: it may
/// wait for a disk as long as that takes, and to start the daemon anew would make it no faster.
/// Public members are thread-safe after start().
class Runtime {
 public:
  /// Without `info` packets are dropped until use_sensor(). @throws InputError when the session
  /// file cannot be created.
  Runtime(const std::optional<SensorInfo>& info, const Config& config,
          std::unique_ptr<PacketSource> source, RuntimeOptions options);
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
  /// Whose packets come from here on. Of another layout: tracking restarts in a new segment, the
  /// map is kept. `this_start`: the sensor has said it itself, so packets of another of its starts
  /// wait for the next call. From one thread only.
  void use_sensor(const SensorInfo& info, bool this_start = false);
  /// From here on only packets from this IP address are taken.
  void set_source_address(const std::string& address) { source_->set_source_address(address); }
  void post(Command command) { crossings_.commands.post(std::move(command)); }
  /// Runs a job on the worker thread. False when too many are waiting. From one thread only.
  [[nodiscard]] bool submit(Job job) { return crossings_.jobs.try_push(job); }
  /// Runs long work on the jobs thread; how it begins. Null while another job runs. From one thread
  /// only.
  [[nodiscard]] std::optional<JobReport> start_job(const std::string& kind, JobBody body);
  /// For jobs that other threads do, and for what is told of all of them.
  /// The back end goes on with another map, or an empty one, as soon as it can; the job is told of
  /// it.
  void change_map(MapChange change) { crossings_.map_change.post(std::move(change)); }
  /// The sensor's place in the map is looked for anew as soon as the back end can.
  void search_place(PlaceSearchRequest request) {
    crossings_.place_search.post(std::move(request));
  }
  /// The latest scan, for those who want to look at it.
  [[nodiscard]] ScanTap& scan_tap() { return crossings_.scan_tap; }
  [[nodiscard]] JobBoard& jobs() { return jobs_; }
  /// Brings the session onto the disk as it is now; for the jobs thread, `job` may be given up
  /// meanwhile. False when it was. @throws InputError when the session cannot be written.
  [[nodiscard]] bool commit_session(RunningJob& job);

  /// Every thread has given a sign of life within `limit_ns`, or has ended as it should.
  [[nodiscard]] bool alive(std::int64_t limit_ns) const;
  /// Why a thread ended as it should not; empty while all is well.
  [[nodiscard]] std::string fault() const;

  /// Null while the sensor is not known.
  [[nodiscard]] std::shared_ptr<const SensorInfo> sensor() const {
    return crossings_.sensor.load();
  }
  [[nodiscard]] double scan_rate_hz() const;
  [[nodiscard]] std::int64_t scan_period_ns() const;
  /// A live stream without packets for so long is silent.
  [[nodiscard]] std::int64_t silence_ns() const { return crossings_.expected.silence_ns; }
  [[nodiscard]] LastPacket last_packet() const;
  [[nodiscard]] const RuntimeOptions& options() const { return options_; }
  [[nodiscard]] EventLog& events() const { return *options_.events; }

 private:
  void spawn(const char* name, std::function<void()> body);
  /// What others give a thread to do, until the queue is closed. `heartbeat`: null for none.
  static void work(BoundedQueue<Job>& queue, Heartbeat* heartbeat);

  const Config config_;
  const RuntimeOptions options_;
  const std::unique_ptr<PacketSource> source_;

  JobBoard jobs_;  ///< Before all that can hold one of its jobs.
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
