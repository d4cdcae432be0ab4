// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/heartbeat.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/sensor_info.hpp"
#include "slam/frontend.hpp"

namespace glint::daemon {

/// Called on the odometry thread after each scan's estimate; must not wait.
using ScanListener = std::function<void(const std::shared_ptr<const Snapshot>&)>;

/// Body of the odometry thread: packets to scans to poses, once a command has told of which sensor.
/// Estimates depend on the packets, their order and the commands only, never on this machine's
/// clock. Owned by that thread.
class OdometryThread {
 public:
  /// `lossless`: wait for a back end that lags (replay) instead of dropping its oldest keyframe.
  OdometryThread(const Config& config, bool lossless, Crossings& crossings, Heartbeat& heartbeat,
                 ScanListener on_scan);

  /// Until the packet queue is closed and empty; closes the keyframe queue then.
  void run();

 private:
  /// What is made for one sensor.
  struct Stream {
    Stream(const UseSensorCommand& use, const slam::SlamConfig& config);
    void set_sensor(const UseSensorCommand& use);
    /// Sent after a restart that the metadata do not know of.
    [[nodiscard]] bool is_of_another_start(const PacketView& packet) const;

    std::shared_ptr<const SensorInfo> info;
    bool this_start;
    std::uint64_t serial_number;  ///< 0: not known.
    ScanAssembler assembler;
    slam::Frontend frontend;
  };

  void take_packet(const ReceivedPacket& received);
  void note_refusal(std::span<const std::byte> packet, PacketVerdict verdict);
  void take_scans();
  void process_scans();
  void process(const LidarScan& scan);
  void hand_over_keyframe();
  void apply_commands();
  void use_sensor(const UseSensorCommand& use);
  void flush();
  void publish_counters();
  std::shared_ptr<const Snapshot> publish();

  const slam::SlamConfig config_;
  const bool lossless_;
  Crossings& crossings_;
  Heartbeat& heartbeat_;
  const ScanListener on_scan_;
  std::optional<Stream> stream_;  ///< Null until the sensor is known.
  Snapshot state_;                ///< The next snapshot.
  HostTime last_host_time_;
  std::int64_t last_arrival_ns_ = 0;
  std::int64_t decode_ns_ = 0;  ///< Time in the assembler since the last scan.
  std::int64_t published_ns_ = 0;
};

}  // namespace glint::daemon
