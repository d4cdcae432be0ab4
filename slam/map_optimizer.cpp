// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_optimizer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "slam/patch_gate.hpp"
#include "slam/recent_map.hpp"
#include "slam/voxel_plane_map.hpp"

namespace glint::slam {
namespace {

// Associations are made anew while a solution moves the scan by more than this.
constexpr double kPoseSettled_m = 0.03;
constexpr double kPoseSettled_rad = 0.002;
// A point that the sensor's turning displaced by more, in a scan that is taken as rigid, would blur
// the map.
constexpr double kDisplaced_m = 0.1;
// What a plane term of weight 1 is good to, squared: the unit of all weights.
constexpr double kUnit_m2 = 0.02 * 0.02;
// Median length of a vector with that deviation along each axis; what the best keypoints reach.
constexpr double kMedianToSigma = 0.65;
constexpr double kBestKeypoint_m = 0.02;
// With fewer residuals there is nothing to be said.
constexpr std::size_t kFewestJointTerms = 30;

PlaneFeatureOptions plane_options(const SlamConfig& config) {
  PlaneFeatureOptions options;
  options.wanted_points = config.plane_points;
  options.in_order = config.plane_map == "tree";
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

std::unique_ptr<PlaneMap> make_map(const SlamConfig& config) {
  if (config.plane_map == "tree") {
    return std::make_unique<RecentMap>(map_options(config), config.local_map_reach_m);
  }
  VoxelPlaneOptions options;
  options.ground_weight = config.ground_weight;
  options.reach_m = config.local_map_reach_m;
  return std::make_unique<VoxelPlaneMap>(options);
}

WindowOptions window_options(const SlamConfig& config) {
  WindowOptions options;
  options.frames = config.ba_frames;
  options.max_hamming_bits = config.match_max_distance;
  options.means = config.ba_by_noise;
  return options;
}

Eigen::Vector2d column_direction(const XyzLut& lut, int column) {
  return lut.point(0, column, 100'000).head<2>().normalized();
}

Eigen::Vector2d middle_direction(const SensorInfo& info, const XyzLut& lut) {
  return column_direction(lut, info.columns_per_frame / 2);
}

double beam_turn_radps(const SensorInfo& info, const XyzLut& lut) {
  const Eigen::Vector2d a = middle_direction(info, lut);
  const Eigen::Vector2d b = column_direction(lut, info.columns_per_frame * 5 / 8);
  const double turn_s = static_cast<double>(info.scan_period_ns()) * 1e-9;
  return (a.x() * b.y() - a.y() * b.x() > 0 ? 2.0 : -2.0) * std::numbers::pi / turn_s;
}

// Of the whole prior, where surfaces hold what `projection` leaves.
Eigen::Matrix<double, 6, 6> information_of(const PosePrior& prior,
                                           const Eigen::Matrix<double, 6, 6>& projection) {
  return prior.information + projection.transpose() * prior.held_information * projection;
}

}  // namespace

MapOptimizer::MapOptimizer(const SensorInfo& info, const SlamConfig& config,
                           std::shared_ptr<const XyzLut> lut)
    : config_(config),
      middle_(middle_direction(info, *lut)),
      turn_radps_(beam_turn_radps(info, *lut)),
      extractor_(info, plane_options(config), lut),
      ground_finder_(ground_options(config)),
      map_(make_map(config)),
      window_(window_options(config)) {
  if (config.patches && config.degeneracy) patches_.emplace(info, std::move(lut));
}

void MapOptimizer::observe(const ScanImages& images, std::span<const Pose> T_reference_column,
                           const Eigen::Vector3d& up) {
  rigid_ = T_reference_column.empty();
  if (patches_) patches_->observe(images, T_reference_column);
  points_m_.clear();
  ground_count_ = 0;
  ground_plane_.reset();
  if (!config_.planes) return;
  points_m_ = extractor_.extract(images, T_reference_column);
  if (config_.ground) ground_plane_ = ground_finder_.find(points_m_, up, &ground_count_);
}

MapOptimization MapOptimizer::optimize(const Features& features, const std::vector<Match>& matches,
                                       const Pose& start, const std::optional<PosePrior>& prior) {
  MapOptimization outcome;
  Pose pose = start;
  JointResult result;
  JointTerms terms;
  if (prior) terms.prior = prior;
  for (int round = 0; round < config_.map_rounds; ++round) {
    if (round == 0) {
      map_->associate(points_m_, ground_count_, pose, planes_);
      associate_keypoints(features, matches, pose);
    } else {
      // Keypoints are told apart by their looks: they keep their partners.
      map_->associate_again(points_m_, ground_count_, pose, planes_);
    }
    if (planes_.size() + points_.size() < kFewestJointTerms) return outcome;
    terms.planes = planes_;
    if (config_.degeneracy) leave_open(pose, terms, outcome.weak_axes);
    if (prior) terms.prior->information = kUnit_m2 * information_of(*prior, terms.plane_projection);
    if (patches_) {
      if (round == 0) pose = place_by_patches(pose, outcome.weak_axes, prior);
      ask_patches(pose, outcome.weak_axes, terms);
    }
    if (config_.ba_by_noise) weigh_keypoints(pose);
    terms.points = points_;
    result = optimize_jointly(pose, terms);
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
  outcome.patch_terms = votes_.patches;
  outcome.covariance = unit_variance_m2(result) * result.hessian().inverse();
  outcome.ok = outcome.covariance.allFinite();
  judge_axes(outcome.weak_axes, votes_, points_, pose, prior && prior->turn_is_measured);
  weak_before_ = outcome.weak_axes;
  return outcome;
}

// Where the patches look most alike, if that can be.
Pose MapOptimizer::place_by_patches(const Pose& pose, const WeakAxes& weak,
                                    const std::optional<PosePrior>& prior) {
  const Pose found = patches_->search(pose, weak);
  patches_agree_ = !prior || agrees_with_motion(found, *prior, weak);
  return patches_agree_ ? found : pose;
}

void MapOptimizer::ask_patches(const Pose& pose, const WeakAxes& weak, JointTerms& terms) {
  votes_ = patches_agree_ ? patches_->votes(pose) : PatchVotes{};
  terms.patches = votes_.term;
  terms.patches->hessian *= kUnit_m2;
  terms.patches->gradient *= kUnit_m2;
  if (outvote_keypoints(votes_)) drop_contradicting(weak, pose, points_);
}

// Of a residual of unit weight: what the weights stand for, or as the residuals show.
double MapOptimizer::unit_variance_m2(const JointResult& result) const {
  if (config_.ba_by_noise) return kUnit_m2;
  return std::max(
      1e-4, result.plane_rms_m * result.plane_rms_m + result.point_rms_m * result.point_rms_m);
}

// Keypoints are worth what they are good to: pictures on walls tell to the centimetre, what noise
// and foliage offer is off by more than they would tell. The median of their residuals says which.
void MapOptimizer::weigh_keypoints(const Pose& pose) {
  residuals_m_.clear();
  for (const PointTerm& term : points_) {
    residuals_m_.push_back((pose * term.point_m - term.fixed_m).norm());
  }
  if (residuals_m_.empty()) return;
  const auto middle = residuals_m_.begin() + static_cast<std::ptrdiff_t>(residuals_m_.size() / 2);
  std::nth_element(residuals_m_.begin(), middle, residuals_m_.end());
  const double sigma_m = std::max(kMedianToSigma * *middle, kBestKeypoint_m);
  const double factor = kUnit_m2 / (sigma_m * sigma_m) * config_.ba_weight / keypoint_weight_;
  for (PointTerm& term : points_) term.weight *= factor;
  keypoint_weight_ *= factor;
}

// Along weak axes the surfaces' noise would outvote keypoints and prior: it gets no vote.
void MapOptimizer::leave_open(const Pose& pose, JointTerms& terms, WeakAxes& weak) const {
  weak = find_weak_axes(planes_, pose, weak_before_);
  terms.plane_projection = projection_without(weak, pose);
}

void MapOptimizer::associate_keypoints(const Features& features, const std::vector<Match>& matches,
                                       const Pose& pose) {
  points_.clear();
  if (config_.ba) points_ = window_.associate(features, matches, pose);
  for (PointTerm& term : points_) term.weight *= config_.ba_weight;
  keypoint_weight_ = config_.ba_weight;
}

void MapOptimizer::drop_displaced(const Eigen::Vector3d& turn_radps) {
  std::size_t kept = 0;
  std::size_t kept_ground = 0;
  for (std::size_t i = 0; i < points_m_.size(); ++i) {
    const Eigen::Vector3d speed_mps = turn_radps.cross(points_m_[i].cast<double>());
    if (speed_mps.norm() * std::abs(seconds_from_middle(points_m_[i])) > kDisplaced_m) continue;
    if (i < ground_count_) ++kept_ground;
    points_m_[kept++] = points_m_[i];
  }
  points_m_.resize(kept);
  ground_count_ = kept_ground;
}

// By its direction: the beams turn evenly.
double MapOptimizer::seconds_from_middle(const Eigen::Vector3f& point_m) const {
  const Eigen::Vector2d p = point_m.head<2>().cast<double>();
  const double angle_rad = std::atan2(middle_.x() * p.y() - middle_.y() * p.x(), middle_.dot(p));
  return angle_rad / turn_radps_;
}

bool MapOptimizer::settled(const Pose& from, const Pose& to) const {
  const Pose step = from.inverse() * to;
  return step.translation_m.norm() < kPoseSettled_m &&
         so3_log(step.rotation).norm() < kPoseSettled_rad;
}

void MapOptimizer::remember(const Features& features, const std::vector<Match>& matches,
                            const Pose& T_odom_scan, const Twist& velocity) {
  if (rigid_) drop_displaced(velocity.tail<3>());
  map_->add(points_m_, ground_count_, T_odom_scan);
  if (patches_) patches_->renew(T_odom_scan, weak_before_);
  if (config_.ba) window_.push(features, matches, T_odom_scan);
}

void MapOptimizer::reset() {
  map_->clear();
  window_.clear();
  if (patches_) patches_->clear();
  weak_before_ = {};
  ground_finder_.reset();
}

}  // namespace glint::slam
