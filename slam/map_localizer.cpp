// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_localizer.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace glint::slam {
namespace {

// Registrations take their errors for independent, odometry's as those on a map: what one keyframe
// says is much the same as what the one before it said.
constexpr double kStepInflation = 10.0;
constexpr double kFixInflation = 4.0;
// No step is known better than this.
constexpr double kStepSigma_m = 0.005;
constexpr double kStepSigma_rad = 0.001;
// What three scans that agree may be off by together.
constexpr double kFoundSigma_m = 0.05;
constexpr double kFoundSigma_rad = 0.01;
// A fix that odometry contradicts is none: 99.9 % of chi^2 with six degrees of freedom.
constexpr double kMostChiSquared = 22.5;
// What clients are told as a jump.
constexpr double kJump_m = 0.1;
constexpr double kJump_rad = 0.02;
// Of the way so far, for past poses; the older half goes when there are more.
constexpr std::size_t kMostAnchors = 4096;

Eigen::Matrix<double, 6, 6> variances(double sigma_m, double sigma_rad) {
  Twist diagonal;
  diagonal.head<3>().setConstant(sigma_m * sigma_m);
  diagonal.tail<3>().setConstant(sigma_rad * sigma_rad);
  return diagonal.asDiagonal();
}

bool is_jump(const Pose& T_map_before, const Pose& T_map_now) {
  const Pose step = T_map_before.inverse() * T_map_now;
  return step.translation_m.norm() > kJump_m || so3_log(step.rotation).norm() > kJump_rad;
}

}  // namespace

MapLocalizer::MapLocalizer(Relocalizer map) : map_(std::move(map)) {}

void MapLocalizer::process(const Keyframe& keyframe, MapCorrection& correction) {
  stamp_ = keyframe.estimate.stamp;
  if (track_ && track_->segment != keyframe.estimate.segment) lose(correction);
  if (!track_) {
    search(keyframe, correction);
  } else if (!keyframe.probe) {
    follow(keyframe, correction);
  }
}

void MapLocalizer::search(const Keyframe& scan, MapCorrection& correction) {
  if (!search_begin_) search_begin_ = stamp_;
  const auto found = map_.locate(scan);
  correction.confidence = map_.confidence();
  if (!found) return;
  begin_track(scan, *found);
  ++correction.epoch;
  tell(scan, correction);
}

void MapLocalizer::begin_track(const Keyframe& scan, const Relocation& found) {
  track_ = Track{scan.id,
                 scan.estimate.segment,
                 scan.estimate.T_odom_sensor,
                 found.T_map_sensor,
                 found.sightings.back().edge.covariance + variances(kFoundSigma_m, kFoundSigma_rad),
                 0};
  search_begin_.reset();
  map_.begin_anew();
}

void MapLocalizer::follow(const Keyframe& keyframe, MapCorrection& correction) {
  Track track = predicted(keyframe);
  const Pose T_map_expected = track.T_map_sensor;
  const auto fix = sight_.fix(map_.places(), make_place(keyframe), T_map_expected);
  if (fix && update(track, *fix)) {
    track.misfits = 0;
    map_.begin_anew();
    track_ = track;
  } else {
    ++track.misfits;
    track_ = track;
    // It may have been carried off without odometry's knowing.
    if (const auto found = map_.locate(keyframe)) begin_track(keyframe, *found);
  }
  if (is_jump(T_map_expected, track_->T_map_sensor)) ++correction.epoch;
  const Twist sigma = track_->covariance.diagonal().cwiseSqrt();
  if (track_->misfits > kMostMisfits || sigma.head<3>().maxCoeff() > kMostSigma_m ||
      sigma.tail<3>().maxCoeff() > kMostSigma_rad) {
    return lose(correction);
  }
  tell(keyframe, correction);
}

// Where odometry carries the keyframe before it.
MapLocalizer::Track MapLocalizer::predicted(const Keyframe& keyframe) const {
  Track track = *track_;
  const Pose step = track.T_odom_sensor.inverse() * keyframe.estimate.T_odom_sensor;
  // Keyframes that never came here were steps, too.
  const std::uint64_t steps =
      keyframe.id > track.id ? std::max<std::uint64_t>(1, keyframe.id - track.id) : 1;
  const Matrix6 carried = adjoint(step.inverse());
  const Matrix6 gained =
      variances(kStepSigma_m, kStepSigma_rad) + kStepInflation * keyframe.edge_covariance;
  track.covariance =
      carried * track.covariance * carried.transpose() + static_cast<double>(steps) * gained;
  track.T_map_sensor = track.T_map_sensor * step;
  track.T_odom_sensor = keyframe.estimate.T_odom_sensor;
  track.id = keyframe.id;
  return track;
}

// False when odometry contradicts the fix: nothing changes then.
bool MapLocalizer::update(Track& track, const MapFix& fix) {
  const Twist off = se3_log(track.T_map_sensor.inverse() * fix.T_map_sensor);
  const Matrix6 noise = kFixInflation * fix.covariance;
  const Eigen::LLT<Matrix6> both(track.covariance + noise);
  if (both.info() != Eigen::Success) return false;
  if (off.dot(both.solve(off)) > kMostChiSquared) return false;
  const Matrix6 gain = both.solve(track.covariance).transpose();
  track.T_map_sensor = track.T_map_sensor * se3_exp(Twist(gain * off));
  // In Joseph's form, which stays symmetric and positive.
  const Matrix6 kept = Matrix6::Identity() - gain;
  track.covariance = kept * track.covariance * kept.transpose() + gain * noise * gain.transpose();
  return true;
}

void MapLocalizer::search_anew(const std::optional<PlaceGuess>& guess, MapCorrection& correction) {
  lose(correction);
  if (guess) map_.begin_near(*guess);
}

void MapLocalizer::lose(MapCorrection& correction) {
  track_.reset();
  search_begin_.reset();
  map_.begin_anew();
  correction.placed = false;
  correction.confidence = 0.0;
  correction.certainty.reset();
  ++correction.epoch;
}

void MapLocalizer::tell(const Keyframe& scan, MapCorrection& correction) const {
  const OdometryEstimate& estimate = scan.estimate;
  correction.T_map_odom = track_->T_map_sensor * track_->T_odom_sensor.inverse();
  correction.placed = true;
  correction.confidence = 1.0 - static_cast<double>(track_->misfits) / (kMostMisfits + 1);
  auto anchors = correction.anchors
                     ? std::make_shared<std::vector<CorrectionAnchor>>(*correction.anchors)
                     : std::make_shared<std::vector<CorrectionAnchor>>();
  if (anchors->size() >= kMostAnchors) {
    anchors->erase(anchors->begin(),
                   anchors->begin() + static_cast<std::ptrdiff_t>(kMostAnchors / 2));
  }
  anchors->push_back({estimate.segment, estimate.sequence, correction.T_map_odom});
  correction.anchors = std::move(anchors);
  correction.certainty = std::make_shared<const PlaceCertainty>(
      PlaceCertainty{track_->T_odom_sensor, track_->covariance});
}

double MapLocalizer::searching_s() const {
  if (!search_begin_) return 0.0;
  return static_cast<double>(stamp_ - *search_begin_) * kSecondsPerNs;
}

}  // namespace glint::slam
