// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/frontend.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/frontend_impl.hpp"
#include "slam/keyframe_points.hpp"

namespace glint::slam {
namespace {

// Scans that must follow one another well before tracking restarts in a new segment.
constexpr int kRestartScans = 3;
// Pairs of keypoints that bear a predicted motion out.
constexpr double kConvincingShare = 0.5;
// What a turn that was found may be off by besides its covariance.
constexpr double kTurnFloor_rad = 5e-4;

RegistrationOptions registration_options(const SlamConfig& config) {
  RegistrationOptions options;
  options.inlier_m = config.registration_inlier_m;
  options.huber_m = config.registration_huber_m;
  options.min_inliers = config.registration_min_inliers;
  if (config.motion_prior) options.convincing_share = kConvincingShare;
  return options;
}

// Keyframes while the place in the map is looked for: three of them within a second.
constexpr std::int64_t kProbeEvery_ns = 250'000'000;

// The projection onto the axes along which surfaces leave the position open.
Eigen::Matrix3d open_axes(const WeakAxes& weak_axes) {
  Eigen::Matrix3d open = Eigen::Matrix3d::Zero();
  for (const WeakAxis& weak : weak_axes) {
    if (!weak.rotation) open += weak.axis * weak.axis.transpose();
  }
  return open;
}

}  // namespace

Frontend::Impl::Impl(const SensorInfo& sensor_info, const SlamConfig& slam_config,
                     Clock given_clock, const Eigen::Quaterniond& R_base_sensor)
    : info(sensor_info),
      config(slam_config),
      clock(given_clock),
      mount{R_base_sensor, Eigen::Vector3d::Zero()},
      lut(std::make_shared<const XyzLut>(info)),
      former(info, config),
      extractor(info, config, lut),
      matcher({config.match_max_distance, config.match_keep_share, config.match_max}),
      registrar(registration_options(config)),
      selector(config),
      prior(config.gyro && config.accelerometer) {
  if (config.planes || config.ba) optimizer.emplace(info, config, lut);
  set_load_level(load_level_of(config.load_level));
}

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
  my.covariance.reset();
  my.estimate.segment = segment;
}

void Frontend::change_sensor(const SensorInfo& info) {
  auto fresh = std::make_unique<Impl>(info, impl_->config, impl_->clock, impl_->mount.rotation);
  fresh->next_keyframe_id = impl_->next_keyframe_id;
  fresh->estimate.segment = impl_->estimate.segment + 1;
  fresh->T_odom_origin = impl_->estimate.T_odom_sensor;
  fresh->imu = impl_->imu;
  impl_ = std::move(fresh);
}

void Frontend::add_imu(const ImuSample& sample) {
  if (impl_->config.gyro) impl_->measurements.push_back(sample);
}

void Frontend::set_searching(bool searching) {
  // The next scan is a keyframe: one that can be tied to the map, should the sensor be at rest.
  if (searching && !impl_->searching) impl_->selector.reset();
  impl_->searching = searching;
}

void Frontend::set_load_level(LoadLevel level) { impl_->set_load_level(level); }

void Frontend::Impl::set_load_level(LoadLevel level) {
  if (level == load_level) return;
  load_level = level;
  const auto share = [&](LoadLevel from, int all) { return level >= from ? all / 2 : all; };
  extractor.set_most(share(LoadLevel::kFewerKeypoints, config.orb_features));
  if (!optimizer) return;
  optimizer->set_sparing_patches(level >= LoadLevel::kFewerPatches);
  optimizer->set_plane_points(share(LoadLevel::kFewerPoints, config.plane_points));
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
  estimate.weak_axes = {};
  const bool usable = observe(scan);
  if (!reference.valid) {
    if (usable) initialize(scan);
    publish(scan, T_odom_origin);
    if (usable) make_keyframe(scan);
    return;
  }
  prediction = predict(reference);
  if (usable) {
    Registration motion;
    if (current.size() > 0) motion = track(scan, reference, prediction.T_reference_current);
    const bool registered = plausible(motion, seconds_since(reference));
    if (!registered) motion.T_reference_current = prediction.T_reference_current;
    if (correct_by_map(scan, registered, motion)) {
      accept(motion, scan);
      return;
    }
  }
  coast(scan);
  if (usable) search_restart(scan);
}

void Frontend::Impl::initialize(const LidarScan& scan) {
  estimate.state = TrackingState::kInit;
  begin_map(scan, T_odom_origin);
  become_reference(scan, reference, T_odom_origin);
}

// The map of a trajectory or segment begins with this scan.
void Frontend::Impl::begin_map(const LidarScan& scan, const Pose& T_odom_scan) {
  begin_at_rest(T_odom_scan);
  if (!optimizer) return;
  optimizer->reset();
  matches.clear();
  observe_surfaces(scan, state, T_odom_scan);
  optimizer->remember(current, matches, T_odom_scan, Twist::Zero());
}

// Nothing is known of the motion; robots mostly stand when they begin, so that what the
// accelerometer feels is the weight alone.
void Frontend::Impl::begin_at_rest(const Pose& T_odom_scan) {
  prior.stop();
  gravity.clear();
  start_level.begin();
  blind_drift.reset();
  const auto felt = imu.between(current_time, current_time + (-info.scan_period_ns()));
  if (felt) prior.level_by(T_odom_scan.rotation * -felt->velocity_mps);
  state = {};
}

void Frontend::Impl::accept(const Registration& motion, const LidarScan& scan) {
  const double dt_s = seconds_since(reference);
  const Pose T_odom_scan = reference.T_odom_scan * motion.T_reference_current;
  learn_from(motion, dt_s);
  follow_gravity(T_odom_scan, dt_s);
  estimate.velocity = state.velocity;
  const Matrix6 increment = covariance_gained(motion, dt_s) +
                            blind_drift.add(weak_axes, T_odom_scan, estimate.velocity, dt_s);
  covariance.add(motion.T_reference_current, increment);
  estimate.covariance = covariance.since_origin();
  estimate.inliers = motion.inliers;
  estimate.weak_axes = weak_axes;
  const bool doubtful =
      blind_drift.is_blind() || scan.completeness() < config.degraded_completeness;
  estimate.state = doubtful ? TrackingState::kDegraded : TrackingState::kTracking;
  failures = 0;
  candidate.valid = false;
  publish(scan, T_odom_scan);
  if (optimizer) {
    const StageTimer timer(clock, times, Stage::kMapOptimization);
    optimizer->remember(current, matches, T_odom_scan, estimate.velocity);
  }
  become_reference(scan, reference, T_odom_scan);
  make_keyframe(scan);
}

// What foretells the next motions: how well this one was foretold, and the gyroscope's bias.
void Frontend::Impl::learn_from(const Registration& motion, double dt_s) {
  prior.open_along(open_axes(weak_axes));
  state = prior.learn(prediction, motion.T_reference_current, reference.T_odom_scan.rotation, dt_s,
                      {motion.covariance, prediction_took_part});
  if (!prediction.by_accelerometer && !predictable(dt_s)) {
    prior.stop();
    state = {};
  }
  const bool turn_is_held = std::none_of(weak_axes.begin(), weak_axes.end(),
                                         [](const WeakAxis& axis) { return axis.rotation; });
  if (!turn_is_held || !config.gyro) return;
  const double sigma_rad =
      std::sqrt(motion.covariance.diagonal().tail<3>().mean()) + kTurnFloor_rad;
  imu.learn_bias(reference.time, current_time, motion.T_reference_current.rotation, sigma_rad);
}

// For the pose graph: how odometry's tilt drifts shows by what the accelerometer feels.
void Frontend::Impl::follow_gravity(const Pose& T_odom_scan, double dt_s) {
  if (!config.accelerometer || measured() == nullptr) return;
  const auto felt = imu.between(reference.time, current_time);
  if (felt) {
    const auto down = start_level.add(reference.T_odom_scan, T_odom_scan, *felt, dt_s);
    if (down) prior.level_anew(*down);
  }
  if (!config.pgo_gravity) return;
  if (felt) {
    gravity.add(reference.T_odom_scan, T_odom_scan, *felt, dt_s);
  } else {
    gravity.clear();
  }
}

// No measurement: the last motion goes on for a few scans, then the pose is held and said to be
// lost.
void Frontend::Impl::coast(const LidarScan& scan) {
  ++failures;
  if (estimate.state == TrackingState::kInit) {
    // Nothing has been tracked yet: begin anew with this scan if it is of use.
    if (sees_enough()) initialize(scan);
    publish(scan, T_odom_origin);
    return;
  }
  if (failures > config.max_coasted_scans) {
    estimate.state = TrackingState::kLost;
    estimate.velocity.setZero();
    state = {};
    return;
  }
  estimate.state = TrackingState::kDegraded;
  covariance.coast();
  estimate.covariance = covariance.since_origin();
  publish(scan, reference.T_odom_scan * prediction.T_reference_current);
}

// While the last good scan is not found again, scans are also registered with their neighbours:
// once a few in a row fit, tracking restarts from the held pose as a new segment, without a link.
void Frontend::Impl::search_restart(const LidarScan& scan) {
  if (estimate.state == TrackingState::kInit) return;
  const bool follows =
      candidate.valid && plausible(track(scan, candidate, {}), seconds_since(candidate));
  candidate_successes = follows ? candidate_successes + 1 : 0;
  if (estimate.state == TrackingState::kLost && candidate_successes >= kRestartScans) {
    ++estimate.segment;
    estimate.state = TrackingState::kTracking;
    failures = 0;
    candidate.valid = false;
    begin_map(scan, estimate.T_odom_sensor);
    become_reference(scan, reference, estimate.T_odom_sensor);
    make_keyframe(scan);
    return;
  }
  become_reference(scan, candidate, estimate.T_odom_sensor);
}

void Frontend::Impl::publish(const LidarScan& scan, const Pose& T_odom_scan) {
  const ScanMotion motion = motion_about(current_time, state);
  estimate.T_odom_sensor = T_odom_scan * motion.at(scan.end_time);
}

void Frontend::Impl::make_keyframe(const LidarScan& scan) {
  // That a scan went without keypoints makes it no new place.
  if (spared_last) return;
  if (selector.select(estimate)) {
    take_keyframe_from(scan, false);
  } else if (wants_probe()) {
    take_keyframe_from(scan, true);
  }
}

bool Frontend::Impl::wants_probe() const {
  return searching && estimate.stamp - last_keyframe >= kProbeEvery_ns;
}

void Frontend::Impl::take_keyframe_from(const LidarScan& scan, bool probe) {
  // `state` is that of the end, or of the middle where it is a constant velocity.
  const ScanMotion motion = motion_about(scan.end_time, state);
  // A scan that is located at its middle moves as a whole from there to its end.
  const Pose T_end_scan = motion.at(current_time);
  keyframe.emplace();
  keyframe->id = next_keyframe_id;
  keyframe->probe = probe;
  keyframe->estimate = estimate;
  last_keyframe = estimate.stamp;
  if (!probe) {
    ++next_keyframe_id;
    keyframe->edge_covariance = covariance.take_since_keyframe();
  }
  keyframe->gravity = gravity.felt();
  keyframe->features = reference.features;
  const Pose T_end_features = T_end_scan * reference.T_scan_features;
  for (Eigen::Vector3d& point_m : keyframe->features.points_m) point_m = T_end_features * point_m;
  keyframe->points = keyframe_points(info, *lut, images, config.map_column_step, [&](int column) {
    return config.deskew ? motion.at(scan.column_time[static_cast<std::size_t>(column)])
                         : T_end_scan;
  });
}

void Frontend::Impl::become_reference(const LidarScan& scan, ReferenceScan& slot,
                                      const Pose& T_odom_scan) {
  place_columns_moving(scan, state);
  if (current.size() > 0 || !slot.valid) {
    // The slot's buffers are used for the next scan.
    std::swap(slot.features, current);
    slot.T_scan_features = {};
  } else {
    slot.T_scan_features = T_odom_scan.inverse() * slot.T_odom_scan * slot.T_scan_features;
  }
  slot.time = current_time;
  slot.sequence = estimate.sequence;
  slot.restarts = restarts;
  slot.T_odom_scan = T_odom_scan;
  slot.valid = true;
}

}  // namespace glint::slam
