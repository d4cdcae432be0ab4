// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kRadPerDeg = M_PI / 180.0;

// Registrations take their errors for independent, which makes their covariance too small; and no
// step is ever known better than the floor says.
constexpr double kOdometryInflation = 10.0;
constexpr double kStepFloor_m = 0.005;
constexpr double kStepFloor_rad = 0.05 * kRadPerDeg;
constexpr double kLoopFloor_m = 0.02;
constexpr double kLoopFloor_rad = 0.15 * kRadPerDeg;

// Of chi^2 with six degrees of freedom.
constexpr double kMeanChiSquared = 6.0;

// Neighbours felt gravity over the same seconds; only every so often it is something new.
constexpr std::int64_t kSightInterval_ns = 8'000'000'000;
// A tilt that is worth moving the map for, when it is beyond doubt.
constexpr double kWorthTilt_rad = 0.5 * kRadPerDeg;
constexpr double kBeyondDoubt = 3.0;

Matrix6 floor_covariance(double sigma_m, double sigma_rad) {
  Twist variances;
  variances.head<3>().setConstant(sigma_m * sigma_m);
  variances.tail<3>().setConstant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

}  // namespace

const Pose& PoseGraph::add(const Keyframe& keyframe) {
  const OdometryEstimate& estimate = keyframe.estimate;
  const Pose T_map_sensor = next(keyframe);
  // Keyframes that never came here were steps, too.
  const std::uint64_t steps =
      nodes_.empty() ? 1 : std::max<std::uint64_t>(1, keyframe.id - nodes_.back().id);
  const Matrix6 least = floor_covariance(kStepFloor_m, kStepFloor_rad);
  Matrix6 covariance = least + kOdometryInflation * keyframe.edge_covariance;
  if (whitening_of(covariance).isZero(0.0)) covariance = least;
  nodes_.push_back(
      {keyframe.id, estimate.sequence, estimate.segment, keyframe.estimate.T_odom_sensor});
  step_covariances_.emplace_back(static_cast<double>(steps) * covariance);
  poses_.push_back(T_map_sensor);
  consistency_.add(nodes_.back(), step_covariances_.back());
  if (options_.gravity && keyframe.gravity) take_gravity(keyframe);
  return poses_.back();
}

Pose PoseGraph::next(const Keyframe& keyframe) const {
  const Pose& T_odom_sensor = keyframe.estimate.T_odom_sensor;
  if (nodes_.empty()) return T_odom_sensor;
  return poses_.back() * (nodes_.back().T_odom_sensor.inverse() * T_odom_sensor);
}

std::optional<Pose> PoseGraph::pose(std::uint64_t id) const {
  const auto node = find(id);
  return node ? std::optional(poses_[*node]) : std::nullopt;
}

void PoseGraph::add_at(const Keyframe& keyframe, const Pose& T_map_sensor) {
  const bool tilted = tilted_;
  add(keyframe);
  poses_.back() = T_map_sensor;
  tilted_ = tilted;  // By the pose that it would have had.
}

void PoseGraph::restore_loop(const LoopEdge& loop) {
  if (!graph_edge(loop)) return;
  add_loop(loop);
  loops_.back().settled = true;
}

void PoseGraph::take_gravity(const Keyframe& keyframe) {
  const OdometryEstimate& estimate = keyframe.estimate;
  if (!sights_.empty() && sights_.back().segment == estimate.segment) {
    const std::int64_t since_ns = estimate.stamp - sights_.back().stamp;
    if (since_ns >= 0 && since_ns < kSightInterval_ns) return;
  }
  sights_.push_back({estimate.stamp, estimate.segment, nodes_.size() - 1, *keyframe.gravity});
  std::vector<Pose> poses = poses_;
  std::vector<GravityFactor> factors = gravity_factors(join_groups(poses));
  const GravityFactor newest = factors.back();
  std::erase_if(factors, [&](const GravityFactor& f) { return f.group != newest.group; });
  const double tilt = tilt_rad(newest, poses_.back(), fit_gravity(factors, poses_));
  tilted_ |= tilt > std::max(kWorthTilt_rad, kBeyondDoubt * newest.felt.sigma_rad);
}

std::vector<GravityFactor> PoseGraph::gravity_factors(std::span<const std::uint32_t> group) const {
  std::vector<GravityFactor> factors;
  factors.reserve(sights_.size());
  for (const GravitySight& sight : sights_) {
    factors.push_back({sight.node, group[sight.node], sight.felt});
  }
  return factors;
}

std::optional<std::size_t> PoseGraph::find(std::uint64_t id) const {
  const auto found = std::ranges::lower_bound(nodes_, id, {}, &GraphNode::id);
  if (found == nodes_.end() || found->id != id) return std::nullopt;
  return static_cast<std::size_t>(found - nodes_.begin());
}

std::optional<GraphEdge> PoseGraph::graph_edge(const LoopEdge& loop) const {
  const auto from = find(loop.from);
  const auto to = find(loop.to);
  if (!from || !to || *from >= *to) return std::nullopt;
  const Matrix6 whitening =
      whitening_of(loop.covariance + floor_covariance(kLoopFloor_m, kLoopFloor_rad));
  if (whitening.isZero(0.0) || !loop.T_from_to.translation_m.allFinite()) return std::nullopt;
  return GraphEdge{*from, *to, loop.T_from_to, whitening, true};
}

std::optional<LoopMisfit> PoseGraph::misfit(const LoopEdge& loop) const {
  const auto edge = graph_edge(loop);
  if (!edge) return std::nullopt;
  const Pose off = loop.T_from_to.inverse() * (poses_[edge->from].inverse() * poses_[edge->to]);
  return LoopMisfit{off.translation_m.norm(), so3_log(off.rotation).norm(),
                    chi_squared(*edge, poses_)};
}

std::vector<std::uint32_t> PoseGraph::groups() const {
  std::vector<Pose> poses = poses_;
  return join_groups(poses);
}

std::vector<LoopEdge> PoseGraph::loops() const {
  std::vector<LoopEdge> edges;
  edges.reserve(loops_.size());
  for (const Loop& loop : loops_) edges.push_back(loop.edge);
  return edges;
}

bool PoseGraph::joined(const LoopEdge& loop) const {
  const auto from = find(loop.from);
  const auto to = find(loop.to);
  if (!from || !to) return false;
  const std::vector<std::uint32_t> group = groups();
  return group[*from] == group[*to];
}

void PoseGraph::add_loop(const LoopEdge& loop) {
  const GraphEdge edge = graph_edge(loop).value();
  Loop& added = loops_.emplace_back(Loop{loop, edge, drift_factor(edge), false, next_loop_++, {}});
  if (options_.loop_consistency) note_contradictions(added);
}

void PoseGraph::note_contradictions(Loop& loop) {
  const auto note = [&](Loop& other) {
    if (&other == &loop || !consistency_.contradict(other.graph_edge, loop.graph_edge)) return;
    loop.against.push_back(other.number);
    other.against.push_back(loop.number);
  };
  std::ranges::for_each(loops_, note);
  std::ranges::for_each(aside_, note);
}

// The loop shows how far odometry drifted on the way. Where that is more than its covariance would
// have it, the covariance is scaled to explain it; otherwise a large drift would tear the loop
// rather than bend the path.
double PoseGraph::drift_factor(const GraphEdge& loop) const {
  if (nodes_[loop.from].segment != nodes_[loop.to].segment) return 1.0;
  Matrix6 covariance = Matrix6::Zero();
  for (std::size_t i = loop.from + 1; i <= loop.to; ++i) {
    const Matrix6 back = adjoint(poses_[i].inverse() * poses_[i - 1]);
    covariance = back * covariance * back.transpose() + step_covariances_[i];
  }
  const Twist off =
      se3_log(loop.T_from_to.inverse() * (poses_[loop.from].inverse() * poses_[loop.to]));
  return std::max(1.0, off.dot(covariance.llt().solve(off)) / kMeanChiSquared);
}

}  // namespace glint::slam
