// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_optimizer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

// Associations are made anew while a solution moves the scan by more than this.
constexpr double kSettled_m = 0.01;
constexpr double kSettled_rad = 0.001;
// With fewer residuals there is nothing to be said.
constexpr std::size_t kFewestTerms = 30;

PlaneFeatureOptions plane_options(const SlamConfig& config) {
  PlaneFeatureOptions options;
  options.wanted_points = config.plane_points;
  return options;
}

GroundOptions ground_options(const SlamConfig& config) {
  GroundOptions options;
  options.sensor_height_m = config.sensor_height_m;
  return options;
}

LocalMapOptions map_options(const SlamConfig& config) {
  LocalMapOptions options;
  options.neighbours = config.plane_neighbours;
  options.voxel_m = config.local_map_voxel_m;
  options.radius_m = config.local_map_radius_m;
  options.ground_weight = config.ground_weight;
  return options;
}

WindowOptions window_options(const SlamConfig& config) {
  WindowOptions options;
  options.frames = config.ba_frames;
  options.max_hamming_bits = config.match_max_distance;
  return options;
}

}  // namespace

MapOptimizer::MapOptimizer(const SensorInfo& info, const SlamConfig& config,
                           std::shared_ptr<const XyzLut> lut)
    : config_(config),
      extractor_(info, plane_options(config), std::move(lut)),
      ground_finder_(ground_options(config)),
      map_(map_options(config)),
      window_(window_options(config)) {}

void MapOptimizer::observe(const LidarScan& scan, const ScanImages& images,
                           const ConstantVelocity* motion, const Eigen::Vector3d& up) {
  points_m_.clear();
  ground_count_ = 0;
  ground_plane_.reset();
  if (!config_.planes) return;
  points_m_ = extractor_.extract(scan, images, motion);
  if (config_.ground) ground_plane_ = ground_finder_.find(points_m_, up, &ground_count_);
}

MapOptimization MapOptimizer::optimize(const Features& features, const std::vector<Match>& matches,
                                       const Pose& start) {
  MapOptimization outcome;
  Pose pose = start;
  JointResult result;
  for (int round = 0; round < config_.map_rounds; ++round) {
    associate(features, matches, pose);
    if (planes_.size() + points_.size() < kFewestTerms) return outcome;
    result = optimize_jointly(pose, planes_, points_);
    if (!result.ok) return outcome;
    const bool done = settled(pose, result.T_odom_scan);
    pose = result.T_odom_scan;
    if (done) break;
  }
  outcome.T_odom_scan = pose;
  outcome.plane_terms = static_cast<int>(planes_.size());
  outcome.overlap = points_m_.empty() ? 0.0
                                      : static_cast<double>(planes_.size()) /
                                            static_cast<double>(points_m_.size());
  outcome.plane_rms_m = result.plane_rms_m;
  outcome.point_terms = static_cast<int>(points_.size());
  const double variance_m2 = std::max(
      1e-4, result.plane_rms_m * result.plane_rms_m + result.point_rms_m * result.point_rms_m);
  outcome.covariance = variance_m2 * result.hessian.inverse();
  outcome.ok = outcome.covariance.allFinite();
  return outcome;
}

void MapOptimizer::associate(const Features& features, const std::vector<Match>& matches,
                             const Pose& pose) {
  map_.associate(points_m_, ground_count_, pose, planes_);
  points_.clear();
  if (config_.ba) points_ = window_.associate(features, matches, pose);
  for (PointTerm& term : points_) term.weight *= config_.ba_weight;
}

bool MapOptimizer::settled(const Pose& from, const Pose& to) const {
  const Pose step = from.inverse() * to;
  return step.translation_m.norm() < kSettled_m && so3_log(step.rotation).norm() < kSettled_rad;
}

void MapOptimizer::remember(const Features& features, const std::vector<Match>& matches,
                            const Pose& T_odom_scan) {
  map_.add(points_m_, ground_count_, T_odom_scan);
  if (config_.ba) window_.push(features, matches, T_odom_scan);
}

void MapOptimizer::reset() {
  map_.clear();
  window_.clear();
  ground_finder_.reset();
}

}  // namespace glint::slam
