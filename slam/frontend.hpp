// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>
#include <optional>

#include "driver/core/clock.hpp"
#include "driver/core/imu_packet.hpp"
#include "driver/core/lidar_scan.hpp"
#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "slam/config.hpp"
#include "slam/keyframe.hpp"
#include "slam/load_level.hpp"
#include "slam/odometry_estimate.hpp"
#include "slam/scan_images.hpp"
#include "slam/stage_times.hpp"

namespace glint::slam {

/// Scans in, poses out: the intensity odometry of [Du & Beltrame 2023, sec. III-A]. Deterministic:
/// the same scans give the same bits, whatever the time they take. Thread-compatible; owned by the
/// odometry thread.
class Frontend {
 public:
  /// `R_base_sensor`: how the sensor is mounted. The odometry frame is parallel to the base at the
  /// first scan, so that its z is up however the sensor hangs; its origin is there in the sensor.
  Frontend(const SensorInfo& info, const SlamConfig& config, Clock clock = {},
           const Eigen::Quaterniond& R_base_sensor = Eigen::Quaterniond::Identity());
  ~Frontend();
  Frontend(const Frontend&) = delete;
  Frontend& operator=(const Frontend&) = delete;

  /// A measurement of the sensor's IMU, in the order of their times; those up to a scan's end
  /// before the scan. Without any, the motion so far foretells the next one.
  void add_imu(const ImuSample& sample);
  /// What is left out from the next scan on. Results depend on it, so that a replay never sets it.
  void set_load_level(LoadLevel level);
  /// While its place in the map is looked for there is a keyframe four times a second, also at
  /// rest: those that are no keyframes otherwise are marked as probes.
  void set_searching(bool searching);
  /// The pose of one scan. Valid until the next call. Never throws on any scan of this sensor.
  const OdometryEstimate& process(const LidarScan& scan);
  /// The keyframe that the last scan gave, if any; a second call gives none.
  std::optional<Keyframe> take_keyframe();
  /// Forgets the trajectory: the next scan is the origin of a new odometry frame (segment + 1).
  void reset();
  /// What follows are scans of another sensor, or of this one in another mode: they go on from the
  /// last pose, without a link (segment + 1). Forgets what it saw, not the numbers of keyframes.
  void change_sensor(const SensorInfo& info);

  /// What the last scan's stages took (kImage ... kRegistration, kTotal).
  [[nodiscard]] const StageTimes& stage_times() const;
  /// The destaggered images of the last scan.
  [[nodiscard]] const ScanImages& images() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint::slam
