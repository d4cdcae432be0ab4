// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// How one scan's motion is found: what it holds, what foretells it, keypoints, surfaces.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/frontend_impl.hpp"
#include "slam/riding_along.hpp"

namespace glint::slam {
namespace {

// A scan with fewer keypoints cannot serve as a reference where there are no surfaces.
constexpr std::size_t kFewestKeypoints = 20;
// The surfaces alone give a pose when so many of them, and this share of them, lie where the map
// has them, this close. Held against another room, some two thirds do, 0.09 m off.
constexpr int kFewestPlanes = 100;
constexpr double kLeastOverlap = 0.5;
constexpr double kLargestRms_m = 0.06;
// Among trees and bushes few points find a plane in a young map, but these fit well.
constexpr double kLeastOverlapOfGoodFit = 0.25;
constexpr double kGoodRms_m = 0.03;
// Longest step over which the motion of the last scan still predicts the next one, s.
constexpr double kLongestPrediction_s = 0.75;
constexpr double kLargeCorrection_m = 0.05;
constexpr double kLargeCorrection_rad = 0.0087;
// IMU measurements that wait for their scan.
constexpr std::size_t kMostMeasurements = 4096;
// What half a scan's prediction adds to its covariance, as a share of a whole one's cautious one.
constexpr double kForetoldShare = 1.0 / 500.0;

bool convincing(const MapOptimization& result) {
  const bool fits = result.overlap > kLeastOverlap && result.plane_rms_m < kLargestRms_m;
  const bool fits_well = result.overlap > kLeastOverlapOfGoodFit && result.plane_rms_m < kGoodRms_m;
  return result.plane_terms >= kFewestPlanes && (fits || fits_well);
}

// A correction so large that the scan must be deskewed anew.
bool is_large(const Pose& before, const Pose& after) {
  const Pose step = before.inverse() * after;
  return step.translation_m.norm() > kLargeCorrection_m ||
         so3_log(step.rotation).norm() > kLargeCorrection_rad;
}

}  // namespace

// Images and features of the scan; false if it holds too little to be of use.
bool Frontend::Impl::observe(const LidarScan& scan) {
  take_measurements_until(scan.end_time);
  weak_axes = {};
  // A rigid scan is as it was in the middle of its sweep. So is, best, one that is straightened by
  // its own motion: at its end an error of that motion would displace it, and feed itself.
  const bool measured_motion =
      measured() != nullptr && imu.between(scan.mid_time, scan.end_time).has_value();
  current_time = config.deskew && measured_motion ? scan.end_time : scan.mid_time;
  {
    const StageTimer timer(clock, times, Stage::kImage);
    former.form(scan, images);
  }
  current.clear();
  if (wants_keypoints()) {
    const StageTimer timer(clock, times, Stage::kFeatures);
    extractor.extract(images, current);
  }
  estimate.keypoints = static_cast<int>(current.size());
  return scan.completeness() >= config.min_completeness && sees_enough();
}

// To serve as a reference.
bool Frontend::Impl::sees_enough() const {
  return current.size() >= kFewestKeypoints || config.planes;
}

// Every second scan goes without where the machine is too slow; one without a reference does not.
bool Frontend::Impl::wants_keypoints() {
  if (!config.intensity) return false;
  const bool spared = load_level >= LoadLevel::kKeypointsEverySecond && config.planes &&
                      reference.valid && failures == 0 && !spared_last;
  spared_last = spared;
  return !spared;
}

// Not those beyond it that happen to be here already: results are to depend on what was measured,
// not on when it came.
void Frontend::Impl::take_measurements_until(SensorTime end) {
  const auto later =
      std::stable_partition(measurements.begin(), measurements.end(),
                            [&](const ImuSample& sample) { return sample.gyro_time <= end; });
  for (auto it = measurements.begin(); it != later; ++it) imu.add(*it);
  measurements.erase(measurements.begin(), later);
  // The sensor's clock went back, or scans stay away.
  if (measurements.size() > kMostMeasurements) measurements.clear();
}

// Where the motion so far leads; after a long gap, only where an IMU tells.
PredictedMotion Frontend::Impl::predict(const ReferenceScan& from) const {
  const double dt_s = seconds_since(from);
  const double span_s =
      dt_s > 0 ? dt_s : static_cast<double>(info.scan_period_ns()) * kSecondsPerNs;
  PredictedMotion predicted =
      prior.predict(from.time, current_time, span_s, from.T_odom_scan.rotation, measured());
  if (!predicted.by_gyro && !predictable(dt_s)) {
    predicted.T_reference_current = {};
    predicted.state = {};
  }
  return predicted;
}

bool Frontend::Impl::predictable(double dt_s) const {
  return dt_s > 0 && dt_s < kLongestPrediction_s;
}

MotionState Frontend::Impl::state_after(const Pose& motion, double dt_s) const {
  if (!prediction.by_accelerometer && !predictable(dt_s)) return {};
  return prior.state_after(prediction, motion, reference.T_odom_scan.rotation, dt_s);
}

// Registers the current scan with an older one; [Du & Beltrame 2023, eqs. 2-3].
Registration Frontend::Impl::track(const LidarScan& scan, const ReferenceScan& from,
                                   const Pose& predicted) {
  const double dt_s = seconds_since(from);
  {
    const StageTimer timer(clock, times, Stage::kMatching);
    matches = matcher.match(from.features.descriptors, current.descriptors);
  }
  estimate.matches = static_cast<int>(matches.size());

  const StageTimer timer(clock, times, Stage::kRegistration);
  if (config.moving_objects && prediction.by_accelerometer) {
    leave_out_riding_along(from.features.points_m, from.T_scan_features, current.points_m,
                           predicted, prediction.largest_sigma_m(), matches);
  }
  Registration motion;
  motion.T_reference_current = predicted;
  // With deskewing, twice: the points of the second pass are moved by the motion found in the
  // first.
  for (int pass = 0; pass < (config.deskew ? 2 : 1); ++pass) {
    place_columns_moving(scan, state_after(motion.T_reference_current, dt_s));
    pairs.clear();
    for (const Match& match : matches) {
      pairs.push_back(
          {from.T_scan_features * from.features.points_m[static_cast<std::size_t>(match.reference)],
           current.points_m[static_cast<std::size_t>(match.current)], match_score(match.distance)});
    }
    motion = pass == 0 ? registrar.align(pairs, predicted)
                       : registrar.refine(pairs, motion.T_reference_current);
    if (!motion.ok) break;
  }
  return motion;
}

// Deskewing: where the sensor was when it measured each column, and the keypoints' points at the
// scan's reference time. A rigid scan stays as it is.
void Frontend::Impl::place_columns_moving(const LidarScan& scan, const MotionState& at) {
  if (!config.deskew) return;
  place_columns(motion_about(current_time, at), scan.column_time, T_reference_column);
  current.deskew(T_reference_column);
}

// Map optimisation: corrects the motion that odometry found. Where it found none, the surfaces may
// tell it by themselves. False if neither does.
bool Frontend::Impl::correct_by_map(const LidarScan& scan, bool registered, Registration& motion) {
  if (!optimizer) return registered;
  const StageTimer timer(clock, times, Stage::kMapOptimization);
  if (!registered) matches.clear();
  prediction_took_part = false;
  MapOptimization result = optimize_by_map(scan, motion);
  Registration corrected = motion;
  corrected.T_reference_current = reference.T_odom_scan.inverse() * result.T_odom_scan;
  if (prediction.by_gyro && config.deskew && result.ok &&
      is_large(motion.T_reference_current, corrected.T_reference_current)) {
    // The points were brought to one instant by another motion than this.
    result = optimize_by_map(scan, corrected);
    corrected.T_reference_current = reference.T_odom_scan.inverse() * result.T_odom_scan;
  }
  if (!result.ok || !(registered || convincing(result))) return registered;
  corrected.ok = true;
  corrected.covariance = result.covariance;
  if (!plausible(corrected, seconds_since(reference))) return registered;
  motion = corrected;
  prediction_took_part = config.motion_prior;
  weak_axes = result.weak_axes;
  return true;
}

MapOptimization Frontend::Impl::optimize_by_map(const LidarScan& scan, const Registration& motion) {
  const Pose start = reference.T_odom_scan * motion.T_reference_current;
  observe_surfaces(scan, state_after(motion.T_reference_current, seconds_since(reference)), start);
  std::optional<PosePrior> pose_prior;
  if (config.motion_prior) {
    pose_prior = {reference.T_odom_scan * prediction.T_reference_current, prediction.information,
                  prediction.held_information(), prediction.by_gyro};
  }
  return optimizer->optimize(current, matches, start, pose_prior);
}

void Frontend::Impl::observe_surfaces(const LidarScan& scan, const MotionState& at,
                                      const Pose& T_odom_scan) {
  place_columns_moving(scan, at);
  optimizer->observe(images, T_reference_column,
                     T_odom_scan.rotation.conjugate() * Eigen::Vector3d::UnitZ());
}

bool Frontend::Impl::plausible(const Registration& motion, double dt_s) const {
  if (!motion.ok) return false;
  // Where a restarted sensor's clock went back, the step is judged as one of neighbouring scans.
  const double span_s =
      dt_s > 0 ? dt_s : static_cast<double>(info.scan_period_ns()) * kSecondsPerNs;
  const Twist step = se3_log(motion.T_reference_current);
  return step.head<3>().norm() <= config.max_speed_mps * span_s &&
         step.tail<3>().norm() <= config.max_turn_rate_radps * span_s;
}

Frontend::Impl::Matrix6 Frontend::Impl::covariance_gained(const Registration& motion,
                                                          double dt_s) const {
  if (!optimizer || !config.ba_by_noise) return motion.covariance;
  Matrix6 own = motion.covariance;
  // From its middle, where a scan is located without an IMU, to its end the motion is foretold.
  if (!prediction.by_gyro) own += kForetoldShare * prediction.information.inverse();
  return drift_gained(own, dt_s);
}

// By the stamps, as long as the number of scans in between bears them out. Otherwise the sensor's
// clock jumped, and the number of scans tells; across a restart they are not numbered through.
double Frontend::Impl::seconds_since(const ReferenceScan& from) const {
  const double stamped_s = static_cast<double>(current_time - from.time) * kSecondsPerNs;
  if (estimate.sequence <= from.sequence || from.restarts != restarts) return stamped_s;
  const double counted_s = static_cast<double>(estimate.sequence - from.sequence) *
                           static_cast<double>(info.scan_period_ns()) * kSecondsPerNs;
  // The rate in the metadata may be off by a factor of two.
  const bool borne_out = stamped_s > 0.4 * counted_s && stamped_s < 2.5 * counted_s;
  return borne_out ? stamped_s : counted_s;
}

ScanMotion Frontend::Impl::motion_about(SensorTime reference_time, const MotionState& at) const {
  // No column is further away than a scan, on a motor that is slower than it should be.
  return {at, reference_time, info.scan_period_ns() + info.scan_period_ns() / 4, measured()};
}

}  // namespace glint::slam
