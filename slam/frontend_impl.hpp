// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "driver/core/xyz_lut.hpp"
#include "slam/blind_drift.hpp"
#include "slam/features.hpp"
#include "slam/frontend.hpp"
#include "slam/gravity_estimate.hpp"
#include "slam/imu_track.hpp"
#include "slam/keyframe_selector.hpp"
#include "slam/map_optimizer.hpp"
#include "slam/matching.hpp"
#include "slam/motion_estimation.hpp"
#include "slam/motion_prior.hpp"
#include "slam/odometry_covariance.hpp"
#include "slam/scan_motion.hpp"
#include "slam/start_level.hpp"

namespace glint::slam {

// A scan that later ones are registered with.
struct ReferenceScan {
  Features features;
  Pose T_scan_features;  // The features may be those of an earlier scan, if it had none of its own.
  SensorTime time;       // The reference time of its points.
  std::uint64_t sequence = 0;
  std::uint64_t restarts = 0;  // Of the sensor, until then.
  Pose T_odom_scan;
  bool valid = false;
};

// The state of a Frontend.
struct Frontend::Impl {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  Impl(const SensorInfo& sensor_info, const SlamConfig& slam_config, Clock given_clock,
       const Eigen::Quaterniond& R_base_sensor);

  void set_load_level(LoadLevel level);

  // What follows from a scan (frontend.cpp).
  void run(const LidarScan& scan);
  void initialize(const LidarScan& scan);
  void begin_map(const LidarScan& scan, const Pose& T_odom_scan);
  void begin_at_rest(const Pose& T_odom_scan);
  void accept(const Registration& motion, const LidarScan& scan);
  void learn_from(const Registration& motion, double dt_s);
  void follow_gravity(const Pose& T_odom_scan, double dt_s);
  void coast(const LidarScan& scan);
  void search_restart(const LidarScan& scan);
  void publish(const LidarScan& scan, const Pose& T_odom_scan);
  void make_keyframe(const LidarScan& scan);
  bool wants_probe() const;
  void take_keyframe_from(const LidarScan& scan, bool probe);
  void become_reference(const LidarScan& scan, ReferenceScan& slot, const Pose& T_odom_scan);

  // How its motion is found (frontend_motion.cpp).
  bool observe(const LidarScan& scan);
  void take_measurements_until(SensorTime end);
  bool wants_keypoints();
  bool sees_enough() const;
  PredictedMotion predict(const ReferenceScan& from) const;
  bool predictable(double dt_s) const;
  MotionState state_after(const Pose& motion, double dt_s) const;
  Registration track(const LidarScan& scan, const ReferenceScan& from, const Pose& predicted);
  void place_columns_moving(const LidarScan& scan, const MotionState& at);
  bool correct_by_map(const LidarScan& scan, bool registered, Registration& motion);
  MapOptimization optimize_by_map(const LidarScan& scan, const Registration& motion);
  void observe_surfaces(const LidarScan& scan, const MotionState& at, const Pose& T_odom_scan);
  bool plausible(const Registration& motion, double dt_s) const;
  Matrix6 covariance_gained(const Registration& motion, double dt_s) const;
  double seconds_since(const ReferenceScan& from) const;
  ScanMotion motion_about(SensorTime reference_time, const MotionState& at) const;
  const ImuTrack* measured() const { return config.gyro ? &imu : nullptr; }

  const SensorInfo info;
  const SlamConfig config;
  const Clock clock;
  const Pose mount;  // T_odom_sensor where a trajectory begins: odometry is upright as the base is.
  const std::shared_ptr<const XyzLut> lut;
  ImageFormer former;
  FeatureExtractor extractor;
  Matcher matcher;
  Registrar registrar;
  KeyframeSelector selector;
  bool searching = false;                 // For its place in the map.
  SensorTime last_keyframe;               // Or probe.
  std::optional<MapOptimizer> optimizer;  // None where all its elements are switched off.

  std::vector<ImuSample> measurements;  // That came since the last scan, or belong after it.
  ImuTrack imu;
  MotionPrior prior;
  GravityEstimate gravity;
  StartLevel start_level;
  MotionState state;  // At the last scan's reference time.

  ScanImages images;
  Features current;
  std::vector<Pose> T_reference_column;  // Of the scan's columns; empty where it is rigid.
  PredictedMotion prediction;
  bool prediction_took_part = false;  // In the motion that was found.
  WeakAxes weak_axes;
  BlindDrift blind_drift;
  SensorTime current_time;
  ReferenceScan reference;  // The last good scan.
  ReferenceScan candidate;  // The last scan, while `reference` is not found again.
  LoadLevel load_level = LoadLevel::kFull;
  bool spared_last = false;  // The last scan went without keypoints.
  std::uint64_t restarts = 0;
  int candidate_successes = 0;
  int failures = 0;            // Scans since the last good one.
  Pose T_odom_origin = mount;  // Of the first scan of a trajectory.
  std::vector<Match> matches;
  std::vector<PointPair> pairs;
  OdometryCovariance covariance;

  OdometryEstimate estimate;
  std::uint64_t next_keyframe_id = 0;
  std::optional<Keyframe> keyframe;
  StageTimes times;
};

}  // namespace glint::slam
