// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/frontend.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "driver/core/destagger.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/deskew.hpp"
#include "slam/features.hpp"
#include "slam/keyframe_selector.hpp"
#include "slam/map_optimizer.hpp"
#include "slam/matching.hpp"
#include "slam/motion_estimation.hpp"

namespace glint::slam {
namespace {

// Scans that must follow one another well before tracking restarts in a new segment.
constexpr int kRestartScans = 3;
// A scan with fewer keypoints cannot serve as a reference.
constexpr std::size_t kFewestKeypoints = 20;
// The surfaces alone give a pose when so many of them, and this share of them, lie where the map
// has them, this close. Held against another room, some two thirds do, 0.09 m off.
constexpr int kFewestPlanes = 100;
constexpr double kLeastOverlap = 0.5;
constexpr double kLargestRms_m = 0.06;
// Longest step over which the motion of the last scan still predicts the next one, s.
constexpr double kLongestPrediction_s = 0.5;
// What a coasted scan adds to the covariance: metres and radians of unknown acceleration.
constexpr double kCoastedSigma_m = 0.1;
constexpr double kCoastedSigma_rad = 0.05;

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Covariance of a * b, where b's is `increment` and a's is `base`, both right perturbations.
Matrix6 compose_covariance(const Matrix6& base, const Pose& b, const Matrix6& increment) {
  const Pose inverse = b.inverse();
  const Eigen::Matrix3d r = inverse.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = inverse.translation_m;
  Eigen::Matrix3d skew;
  skew << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Matrix6 adjoint = Matrix6::Zero();
  adjoint.topLeftCorner<3, 3>() = r;
  adjoint.topRightCorner<3, 3>() = skew * r;
  adjoint.bottomRightCorner<3, 3>() = r;
  return adjoint * base * adjoint.transpose() + increment;
}

bool convincing(const MapOptimization& result) {
  return result.plane_terms >= kFewestPlanes && result.overlap > kLeastOverlap &&
         result.plane_rms_m < kLargestRms_m;
}

// A scan that later ones are registered with.
struct ReferenceScan {
  Features features;
  SensorTime time;  // The reference time of its points.
  std::uint64_t sequence = 0;
  std::uint64_t restarts = 0;  // Of the sensor, until then.
  Pose T_odom_scan;
  bool valid = false;
};

}  // namespace

struct Frontend::Impl {
  Impl(const SensorInfo& sensor_info, const SlamConfig& slam_config, Clock given_clock,
       const Eigen::Quaterniond& R_base_sensor)
      : info(sensor_info),
        config(slam_config),
        clock(given_clock),
        mount{R_base_sensor, Eigen::Vector3d::Zero()},
        lut(std::make_shared<const XyzLut>(info)),
        former(info, config),
        extractor(info, config, lut),
        matcher({config.match_max_distance, config.match_keep_share, config.match_max}),
        registrar({config.registration_inlier_m, config.registration_huber_m,
                   config.registration_min_inliers}),
        selector(config) {
    if (config.planes || config.ba) optimizer.emplace(info, config, lut);
  }

  void run(const LidarScan& scan);
  bool observe(const LidarScan& scan);
  void initialize(const LidarScan& scan);
  void begin_map(const LidarScan& scan, const Pose& T_odom_scan);
  Registration track(const ReferenceScan& from, const Twist& predicted_velocity);
  Registration predicted() const;
  bool plausible(const Registration& motion, double dt_s) const;
  void observe_surfaces(const LidarScan& scan, const Twist& velocity, const Pose& T_odom_scan);
  bool correct_by_map(const LidarScan& scan, bool registered, Registration& motion);
  void accept(const Registration& motion, const LidarScan& scan);
  void coast(const LidarScan& scan);
  void search_restart(const LidarScan& scan);
  void publish(const LidarScan& scan, const Pose& T_odom_scan);
  void make_keyframe(const LidarScan& scan);
  void become_reference(ReferenceScan& slot, const Pose& T_odom_scan);
  double seconds_since(const ReferenceScan& from) const;
  ConstantVelocity motion_about(SensorTime reference_time, const Twist& velocity) const;

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
  std::optional<MapOptimizer> optimizer;  // None where all its elements are switched off.

  ScanImages images;
  Features current;
  SensorTime current_time;
  ReferenceScan reference;  // The last good scan.
  ReferenceScan candidate;  // The last scan, while `reference` is not found again.
  std::uint64_t restarts = 0;
  int candidate_successes = 0;
  int failures = 0;            // Scans since the last good one.
  Pose T_odom_origin = mount;  // Of the first scan of a trajectory.
  std::vector<Match> matches;
  std::vector<PointPair> pairs;
  Matrix6 edge_covariance = Matrix6::Zero();  // Of the motion since the last keyframe.

  OdometryEstimate estimate;
  std::uint64_t next_keyframe_id = 0;
  std::optional<Keyframe> keyframe;
  StageTimes times;
};

Frontend::Frontend(const SensorInfo& info, const SlamConfig& config, Clock clock,
                   const Eigen::Quaterniond& R_base_sensor)
    : impl_(std::make_unique<Impl>(info, config, clock, R_base_sensor)) {}

Frontend::~Frontend() = default;

const OdometryEstimate& Frontend::process(const LidarScan& scan) {
  impl_->times = {};
  impl_->keyframe.reset();
  const StageTimer timer(impl_->clock, impl_->times, Stage::kTotal);
  impl_->run(scan);
  return impl_->estimate;
}

std::optional<Keyframe> Frontend::take_keyframe() { return std::exchange(impl_->keyframe, {}); }

void Frontend::reset() {
  Impl& my = *impl_;
  my.reference.valid = false;
  my.candidate.valid = false;
  my.failures = 0;
  my.T_odom_origin = my.mount;
  my.selector.reset();
  if (my.optimizer) my.optimizer->reset();
  const std::uint32_t segment = my.estimate.segment + 1;
  my.estimate = {};
  my.estimate.segment = segment;
}

void Frontend::change_sensor(const SensorInfo& info) {
  auto fresh = std::make_unique<Impl>(info, impl_->config, impl_->clock, impl_->mount.rotation);
  fresh->next_keyframe_id = impl_->next_keyframe_id;
  fresh->estimate.segment = impl_->estimate.segment + 1;
  fresh->T_odom_origin = impl_->estimate.T_odom_sensor;
  impl_ = std::move(fresh);
}

const StageTimes& Frontend::stage_times() const { return impl_->times; }

const ScanImages& Frontend::images() const { return impl_->images; }

void Frontend::Impl::run(const LidarScan& scan) {
  estimate.sequence = scan.sequence;
  estimate.frame_id = scan.frame_id;
  estimate.stamp = scan.end_time;
  if (scan.sensor_restarted) ++restarts;
  estimate.completeness = scan.completeness();
  estimate.matches = 0;
  estimate.inliers = 0;
  const bool usable = observe(scan);
  if (!reference.valid) {
    if (usable) initialize(scan);
    publish(scan, T_odom_origin);
    if (usable) make_keyframe(scan);
    return;
  }
  if (usable) {
    Registration motion;
    if (config.intensity) motion = track(reference, estimate.velocity);
    const bool registered = plausible(motion, seconds_since(reference));
    if (!registered) motion = predicted();
    if (correct_by_map(scan, registered, motion)) {
      accept(motion, scan);
      return;
    }
  }
  coast(scan);
  if (usable) search_restart(scan);
}

// Images and features of the scan; false if it holds too little to be of use.
bool Frontend::Impl::observe(const LidarScan& scan) {
  // Without deskewing the scan is taken as rigid at the middle of its sweep.
  current_time = config.deskew ? scan.end_time : scan.mid_time;
  {
    const StageTimer timer(clock, times, Stage::kImage);
    former.form(scan, images);
  }
  if (config.intensity) {
    const StageTimer timer(clock, times, Stage::kFeatures);
    extractor.extract(scan, images, current);
  }
  estimate.keypoints = static_cast<int>(current.size());
  return scan.completeness() >= config.min_completeness &&
         (current.size() >= kFewestKeypoints || config.planes);
}

void Frontend::Impl::initialize(const LidarScan& scan) {
  estimate.state = TrackingState::kInit;
  begin_map(scan, T_odom_origin);
  become_reference(reference, T_odom_origin);
}

// The map of a trajectory or segment begins with this scan.
void Frontend::Impl::begin_map(const LidarScan& scan, const Pose& T_odom_scan) {
  if (!optimizer) return;
  optimizer->reset();
  matches.clear();
  observe_surfaces(scan, Twist::Zero(), T_odom_scan);
  optimizer->remember(current, matches, T_odom_scan, Twist::Zero());
}

// Registers the current scan with an older one; [Du & Beltrame 2023, eqs. 2-3].
Registration Frontend::Impl::track(const ReferenceScan& from, const Twist& predicted_velocity) {
  const double dt_s = seconds_since(from);
  const bool predictable = dt_s > 0 && dt_s < kLongestPrediction_s;
  Twist velocity = predictable ? predicted_velocity : Twist::Zero();
  {
    const StageTimer timer(clock, times, Stage::kMatching);
    matches = matcher.match(from.features.descriptors, current.descriptors);
  }
  estimate.matches = static_cast<int>(matches.size());

  const StageTimer timer(clock, times, Stage::kRegistration);
  Registration motion;
  // With deskewing, twice: the points of the second pass are moved by the motion found in the
  // first.
  for (int pass = 0; pass < (config.deskew ? 2 : 1); ++pass) {
    if (config.deskew) {
      deskew(current.raw_points_m, current.times, motion_about(current_time, velocity),
             current.points_m);
    }
    pairs.clear();
    for (const Match& match : matches) {
      pairs.push_back({from.features.points_m[static_cast<std::size_t>(match.reference)],
                       current.points_m[static_cast<std::size_t>(match.current)],
                       match_score(match.distance)});
    }
    motion = pass == 0 ? registrar.align(pairs, se3_exp(velocity * dt_s))
                       : registrar.refine(pairs, motion.T_reference_current);
    if (!motion.ok) break;
    if (predictable) velocity = se3_log(motion.T_reference_current) / dt_s;
  }
  return motion;
}

// Where no keypoints tell it: the motion goes on.
Registration Frontend::Impl::predicted() const {
  const double dt_s = seconds_since(reference);
  const bool predictable = dt_s > 0 && dt_s < kLongestPrediction_s;
  Registration motion;
  if (predictable) motion.T_reference_current = se3_exp(estimate.velocity * dt_s);
  return motion;
}

void Frontend::Impl::observe_surfaces(const LidarScan& scan, const Twist& velocity,
                                      const Pose& T_odom_scan) {
  const ConstantVelocity motion = motion_about(current_time, velocity);
  optimizer->observe(scan, images, config.deskew ? &motion : nullptr,
                     T_odom_scan.rotation.conjugate() * Eigen::Vector3d::UnitZ());
}

// Map optimisation: corrects the motion that odometry found. Where it found none, the surfaces may
// tell it by themselves. False if neither does.
bool Frontend::Impl::correct_by_map(const LidarScan& scan, bool registered, Registration& motion) {
  if (!optimizer) return registered;
  const StageTimer timer(clock, times, Stage::kMapOptimization);
  const double dt_s = seconds_since(reference);
  const bool predictable = dt_s > 0 && dt_s < kLongestPrediction_s;
  const Pose start = reference.T_odom_scan * motion.T_reference_current;
  observe_surfaces(
      scan, predictable ? Twist(se3_log(motion.T_reference_current) / dt_s) : Twist::Zero(), start);
  if (!registered) matches.clear();
  const MapOptimization result = optimizer->optimize(current, matches, start);
  if (!result.ok || !(registered || convincing(result))) return registered;
  Registration corrected = motion;
  corrected.ok = true;
  corrected.T_reference_current = reference.T_odom_scan.inverse() * result.T_odom_scan;
  corrected.covariance = result.covariance;
  if (!plausible(corrected, dt_s)) return registered;
  motion = corrected;
  return true;
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

void Frontend::Impl::accept(const Registration& motion, const LidarScan& scan) {
  const double dt_s = seconds_since(reference);
  const bool predictable = dt_s > 0 && dt_s < kLongestPrediction_s;
  estimate.velocity =
      predictable ? Twist(se3_log(motion.T_reference_current) / dt_s) : Twist::Zero();
  estimate.covariance =
      compose_covariance(estimate.covariance, motion.T_reference_current, motion.covariance);
  edge_covariance =
      compose_covariance(edge_covariance, motion.T_reference_current, motion.covariance);
  estimate.inliers = motion.inliers;
  estimate.state = scan.completeness() < config.degraded_completeness ? TrackingState::kDegraded
                                                                      : TrackingState::kTracking;
  failures = 0;
  candidate.valid = false;
  const Pose T_odom_scan = reference.T_odom_scan * motion.T_reference_current;
  publish(scan, T_odom_scan);
  if (optimizer) {
    const StageTimer timer(clock, times, Stage::kMapOptimization);
    optimizer->remember(current, matches, T_odom_scan, estimate.velocity);
  }
  become_reference(reference, T_odom_scan);
  make_keyframe(scan);
}

// No measurement: the last motion goes on for a few scans, then the pose is held and said to be
// lost.
void Frontend::Impl::coast(const LidarScan& scan) {
  ++failures;
  if (estimate.state == TrackingState::kInit) {
    // Nothing has been tracked yet: begin anew with this scan if it is of use.
    if (current.size() >= kFewestKeypoints || config.planes) initialize(scan);
    publish(scan, T_odom_origin);
    return;
  }
  if (failures > config.max_coasted_scans) {
    estimate.state = TrackingState::kLost;
    estimate.velocity.setZero();
    return;
  }
  estimate.state = TrackingState::kDegraded;
  Twist sigma;
  sigma << kCoastedSigma_m, kCoastedSigma_m, kCoastedSigma_m, kCoastedSigma_rad, kCoastedSigma_rad,
      kCoastedSigma_rad;
  const double dt_s = seconds_since(reference);
  const bool predictable = dt_s > 0 && dt_s < kLongestPrediction_s;
  const Pose motion = predictable ? se3_exp(estimate.velocity * dt_s) : Pose{};
  estimate.covariance += Matrix6(sigma.cwiseAbs2().asDiagonal());
  edge_covariance += Matrix6(sigma.cwiseAbs2().asDiagonal());
  publish(scan, reference.T_odom_scan * motion);
}

// While the last good scan is not found again, scans are also registered with their neighbours:
// once a few in a row fit, tracking restarts from the held pose as a new segment, without a link.
void Frontend::Impl::search_restart(const LidarScan& scan) {
  if (estimate.state == TrackingState::kInit) return;
  const bool follows =
      candidate.valid && plausible(track(candidate, Twist::Zero()), seconds_since(candidate));
  candidate_successes = follows ? candidate_successes + 1 : 0;
  if (estimate.state == TrackingState::kLost && candidate_successes >= kRestartScans) {
    ++estimate.segment;
    estimate.state = TrackingState::kTracking;
    failures = 0;
    candidate.valid = false;
    begin_map(scan, estimate.T_odom_sensor);
    become_reference(reference, estimate.T_odom_sensor);
    make_keyframe(scan);
    return;
  }
  become_reference(candidate, estimate.T_odom_sensor);
}

void Frontend::Impl::publish(const LidarScan& scan, const Pose& T_odom_scan) {
  const ConstantVelocity motion = motion_about(current_time, estimate.velocity);
  estimate.T_odom_sensor = T_odom_scan * motion.at(scan.end_time);
}

void Frontend::Impl::make_keyframe(const LidarScan& scan) {
  if (!selector.select(estimate)) return;
  const auto columns = static_cast<int>(scan.column_time.size());
  const ConstantVelocity motion = motion_about(scan.end_time, estimate.velocity);
  // A rigid scan moves as a whole from its middle to its end.
  const Pose T_end_middle = motion.at(current_time);
  keyframe.emplace();
  keyframe->id = next_keyframe_id++;
  keyframe->estimate = estimate;
  keyframe->edge_covariance = edge_covariance;
  edge_covariance.setZero();
  keyframe->features = reference.features;
  for (Eigen::Vector3d& point_m : keyframe->features.points_m) point_m = T_end_middle * point_m;
  for (int m = 0; m < columns; m += std::max(1, config.map_column_step)) {
    const auto column = static_cast<std::size_t>(m);
    const Pose T_end_column = config.deskew ? motion.at(scan.column_time[column]) : T_end_middle;
    for (int row = 0; row < info.pixels_per_column; ++row) {
      const int shift = info.pixel_shift_by_row[static_cast<std::size_t>(row)];
      const int u = ((m + shift) % columns + columns) % columns;
      const std::uint32_t range_mm = images.range_mm(row, u);
      if (range_mm == 0) continue;
      const Eigen::Vector3f p = (T_end_column * lut->point(row, m, range_mm)).cast<float>();
      keyframe->points.push_back(
          {p.x(), p.y(), p.z(), static_cast<float>(images.intensity_u8(row, u))});
    }
  }
}

void Frontend::Impl::become_reference(ReferenceScan& slot, const Pose& T_odom_scan) {
  if (config.deskew) {
    deskew(current.raw_points_m, current.times, motion_about(current_time, estimate.velocity),
           current.points_m);
  }
  // The slot's buffers are used for the next scan.
  std::swap(slot.features, current);
  slot.time = current_time;
  slot.sequence = estimate.sequence;
  slot.restarts = restarts;
  slot.T_odom_scan = T_odom_scan;
  slot.valid = true;
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

ConstantVelocity Frontend::Impl::motion_about(SensorTime reference_time,
                                              const Twist& velocity) const {
  // No column is further away than a scan, on a motor that is slower than it should be.
  return {velocity, reference_time, info.scan_period_ns() + info.scan_period_ns() / 4};
}

}  // namespace glint::slam
