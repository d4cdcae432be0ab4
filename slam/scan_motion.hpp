// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/time.hpp"
#include "slam/imu_track.hpp"

namespace glint::slam {

/// How the sensor moves at some time: in the sensor frame of that time. Value type.
struct MotionState {
  Twist velocity = Twist::Zero();  ///< m/s and rad/s.
  /// What falls there accelerates so, m/s^2; zero where it is not known.
  Eigen::Vector3d gravity_mps2 = Eigen::Vector3d::Zero();
};

/// How the sensor moved about a reference time: as its IMU measured where it did, else at a
/// constant body velocity. Value type.
class ScanMotion {
 public:
  /// `state` at the reference time. Times further than `longest_ns` from it are taken to be that
  /// far: the sensor's clock jumped in between. `imu` may be null; it must outlive this.
  ScanMotion(const MotionState& state, SensorTime reference, std::int64_t longest_ns,
             const ImuTrack* imu = nullptr)
      : state_(state), reference_(reference), longest_ns_(longest_ns), imu_(imu) {}

  /// T_reference_t: takes points measured at `t` to the sensor frame at the reference time.
  [[nodiscard]] Pose at(SensorTime t) const;

 private:
  MotionState state_;
  SensorTime reference_;
  std::int64_t longest_ns_;
  const ImuTrack* imu_;
};

/// The motion that follows `state` for `span_s`, which the IMU measured as `imu`.
Pose carried_on(const MotionState& state, const ImuMotion& imu, double span_s);

/// The motion to the reference time of each of a scan's columns.
void place_columns(const ScanMotion& motion, std::span<const SensorTime> column_times,
                   std::vector<Pose>& T_reference_column);

}  // namespace glint::slam
