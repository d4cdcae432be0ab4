// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/bounded_queue.hpp"
#include "daemon/record/capture_parts.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/session/sensor_session.hpp"
#include "driver/udp_source.hpp"
#include "pcap/endpoint.hpp"

namespace glint::daemon {

/// What a recorder has received. Value type.
struct ReceivedCounts {
  std::uint64_t lidar = 0;
  std::uint64_t imu = 0;
  std::uint64_t other = 0;
};

/// Two threads between a socket and a capture: one receives, the other writes and waits for the
/// disk. Thread-safe.
class PacketRecorder {
 public:
  struct Line {
    UdpSourceOptions udp;
    IpAddress sensor;
    IpAddress host;
  };

  /// Begins at once. `parts` is used on the recorder's thread only and must outlive it. `on_error`
  /// is called on one of its threads, once, with a sentence.
  /// @throws InputError when a port cannot be had.
  PacketRecorder(const Line& line, const SensorInfo& info, CaptureParts& parts,
                 std::function<void(const std::string&)> on_error);
  /// Stops.
  ~PacketRecorder();
  PacketRecorder(const PacketRecorder&) = delete;
  PacketRecorder& operator=(const PacketRecorder&) = delete;

  /// What has been received is still written, then the capture is finished.
  void stop();
  /// For files that begin from now on.
  void set_metadata(std::string metadata_json);

  [[nodiscard]] ReceivedCounts counts() const;
  [[nodiscard]] std::uint64_t disk_drops() const { return queue_.dropped(); }
  [[nodiscard]] std::uint64_t kernel_drops() const { return source_.kernel_drops(); }
  [[nodiscard]] int granted_rcvbuf_bytes() const { return source_.granted_rcvbuf_bytes(); }
  /// On the monotonic clock.
  [[nodiscard]] PacketActivity activity() const;

 private:
  void receive();
  void take(RawPacket& packet);
  void write();
  void write_all();
  void fail(const std::string& sentence);

  const Line line_;
  const PacketFormat format_;
  CaptureParts& parts_;
  const std::function<void(const std::string&)> on_error_;
  UdpSource source_;
  BoundedQueue<RawPacket> queue_;
  std::atomic<std::uint64_t> lidar_ = 0;
  std::atomic<std::uint64_t> imu_ = 0;
  std::atomic<std::uint64_t> other_ = 0;
  std::atomic<std::int64_t> last_packet_ns_ = 0;
  std::atomic<std::uint32_t> init_id_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::string next_metadata_;  ///< Guarded by mutex_; empty when there is none.
  std::thread receiver_;
  std::thread writer_;
};

}  // namespace glint::daemon
