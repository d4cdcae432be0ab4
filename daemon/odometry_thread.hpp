// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/event_log.hpp"
#include "daemon/heartbeat.hpp"
#include "daemon/load_governor.hpp"
#include "driver/core/clock_model.hpp"
#include "driver/core/gravity.hpp"
#include "driver/core/imu_packet.hpp"
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
                 EventLog& events, ScanListener on_scan);

  /// Until the packet queue is closed and empty; closes the keyframe queue then.
  void run();

 private:
  /// What is made for one sensor.
  struct Stream {
    Stream(const UseSensorCommand& use, const slam::SlamConfig& config,
           const Eigen::Quaterniond& R_base_sensor);
    void set_sensor(const UseSensorCommand& use);
    /// Sent after a restart that the metadata do not know of.
    [[nodiscard]] bool is_of_another_start(const PacketView& packet) const;

    std::shared_ptr<const SensorInfo> info;
    bool this_start;
    std::uint64_t serial_number;  ///< 0: not known.
    ImuPacketFormat imu_format;
    ScanAssembler assembler;
    ClockModel clock_model;
    slam::Frontend frontend;
  };

  void take_packet(const ReceivedPacket& received);
  void note_refusal(std::span<const std::byte> packet, PacketVerdict verdict);
  void take_imu(std::span<const std::byte> bytes);
  void look_at_clock(const PacketView& packet, HostTime host_time);
  void take_scans();
  void process_scans();
  void process(const LidarScan& scan);
  /// The time that clients are told: the sensor's, or that of this machine if they want it.
  [[nodiscard]] SensorTime told_time(SensorTime stamp) const;
  void choose_load(double took_s);
  void hand_over_keyframe();
  void show(const LidarScan& scan, SensorTime stamp);
  void apply_commands();
  void take_correction(const slam::MapCorrection& correction);
  void use_sensor(const UseSensorCommand& use);
  void flush();
  void publish_counters();
  void tell_stream(const Stream& stream);
  std::shared_ptr<const Snapshot> publish();

  const slam::SlamConfig config_;
  const bool lossless_;
  const Eigen::Quaterniond R_base_sensor_;
  Crossings& crossings_;
  Heartbeat& heartbeat_;
  EventLog& events_;
  const ScanListener on_scan_;
  std::optional<Stream> stream_;  ///< Null until the sensor is known.
  LoadGovernor governor_;
  GravityEstimate gravity_;
  std::vector<ImuSample> imu_samples_;
  Snapshot state_;  ///< The next snapshot.
  std::int64_t last_arrival_ns_ = 0;
  std::int64_t decode_ns_ = 0;  ///< Time in the assembler since the last scan.
  std::int64_t published_ns_ = 0;
};

}  // namespace glint::daemon
