// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/event_log.hpp"
#include "daemon/heartbeat.hpp"
#include "driver/core/clock_model.hpp"
#include "driver/core/gravity.hpp"
#include "driver/core/imu_packet.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/sensor_info.hpp"
#include "slam/frontend.hpp"

namespace glint::daemon {

/// Called on the odometry thread after each scan's estimate; must not wait.
using ScanListener = std::function<void(const std::shared_ptr<const Snapshot>&)>;

/// Body of the odometry thread: packets to scans to poses. Estimates depend on the packets, their
/// order and the commands only, never on this machine's clock. Owned by that thread.
class OdometryThread {
 public:
  /// `lossless`: wait for a back end that lags (replay) instead of dropping its oldest keyframe.
  OdometryThread(const SensorInfo& info, const Config& config, bool lossless, Crossings& crossings,
                 Heartbeat& heartbeat, EventLog& events, ScanListener on_scan);

  /// Until the packet queue is closed and empty; closes the keyframe queue then.
  void run();

 private:
  void take_packet(const ReceivedPacket& received);
  void take_imu(std::span<const std::byte> bytes);
  void look_at_clock(const RawPacket& packet);
  void take_scans();
  void process(const LidarScan& scan);
  /// The time that clients are told: the sensor's, or that of this machine if they want it.
  [[nodiscard]] SensorTime told_time(SensorTime stamp) const;
  void hand_over_keyframe();
  void apply_commands();
  void publish_counters();
  std::shared_ptr<const Snapshot> publish();

  const bool lossless_;
  const ClockSource clock_source_;
  const Eigen::Quaterniond R_base_sensor_;
  const ImuPacketFormat imu_format_;
  Crossings& crossings_;
  Heartbeat& heartbeat_;
  EventLog& events_;
  const ScanListener on_scan_;
  ScanAssembler assembler_;
  ClockModel clock_model_;
  GravityEstimate gravity_;
  std::vector<ImuSample> imu_samples_;
  slam::Frontend frontend_;
  Snapshot state_;  ///< The next snapshot.
  std::int64_t last_arrival_ns_ = 0;
  std::int64_t decode_ns_ = 0;  ///< Time in the assembler since the last scan.
  std::int64_t published_ns_ = 0;
};

}  // namespace glint::daemon
