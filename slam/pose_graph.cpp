// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>

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

// Mean of chi^2 with six degrees of freedom, and the bound that 95 % stay below.
constexpr double kMeanChiSquared = 6.0;
constexpr double kLargestChiSquared = 12.6;

Matrix6 floor_covariance(double sigma_m, double sigma_rad) {
  Twist variances;
  variances.head<3>().setConstant(sigma_m * sigma_m);
  variances.tail<3>().setConstant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

}  // namespace

const Pose& PoseGraph::add(const Keyframe& keyframe) {
  const OdometryEstimate& estimate = keyframe.estimate;
  Pose T_map_sensor = estimate.T_odom_sensor;
  // Keyframes that never came here were steps, too.
  std::uint64_t steps = 1;
  if (!nodes_.empty()) {
    const GraphNode& last = nodes_.back();
    T_map_sensor = poses_.back() * (last.T_odom_sensor.inverse() * estimate.T_odom_sensor);
    steps = std::max<std::uint64_t>(1, keyframe.id - last.id);
  }
  const Matrix6 least = floor_covariance(kStepFloor_m, kStepFloor_rad);
  Matrix6 covariance = least + kOdometryInflation * keyframe.edge_covariance;
  if (whitening_of(covariance).isZero(0.0)) covariance = least;
  nodes_.push_back(
      {keyframe.id, estimate.sequence, estimate.segment, keyframe.estimate.T_odom_sensor});
  step_covariances_.emplace_back(static_cast<double>(steps) * covariance);
  poses_.push_back(T_map_sensor);
  return poses_.back();
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

bool PoseGraph::joined(const LoopEdge& loop) const {
  const auto from = find(loop.from);
  const auto to = find(loop.to);
  if (!from || !to) return false;
  std::vector<Pose> poses = poses_;
  const std::vector<std::uint32_t> group = join_groups(poses);
  return group[*from] == group[*to];
}

void PoseGraph::add_loop(const LoopEdge& loop) {
  const GraphEdge edge = graph_edge(loop).value();
  loops_.push_back({loop, edge, drift_factor(edge), false});
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

// The group of each node, named by its lowest segment: loop after loop joins the groups of its
// ends. The later one is then set down in `poses` where the loop has it.
std::vector<std::uint32_t> PoseGraph::join_groups(std::span<Pose> poses) const {
  std::vector<std::uint32_t> group;
  group.reserve(nodes_.size());
  for (const GraphNode& node : nodes_) group.push_back(node.segment);
  for (const Loop& loop : loops_) {
    const GraphEdge& edge = loop.graph_edge;
    const std::uint32_t stays = std::min(group[edge.from], group[edge.to]);
    const std::uint32_t moves = std::max(group[edge.from], group[edge.to]);
    if (stays == moves) continue;
    Pose motion = poses[edge.from] * edge.T_from_to * poses[edge.to].inverse();
    if (group[edge.from] == moves) motion = motion.inverse();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (group[i] != moves) continue;
      poses[i] = motion * poses[i];
      group[i] = stays;
    }
  }
  return group;
}

std::vector<GraphEdge> PoseGraph::edges() const {
  std::vector<double> drift(nodes_.size(), 1.0);
  for (const Loop& loop : loops_) {
    for (std::size_t i = loop.graph_edge.from + 1; i <= loop.graph_edge.to; ++i) {
      drift[i] = std::max(drift[i], loop.drift_factor);
    }
  }
  std::vector<GraphEdge> edges;
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    if (nodes_[i - 1].segment != nodes_[i].segment) continue;
    edges.push_back({i - 1, i, nodes_[i - 1].T_odom_sensor.inverse() * nodes_[i].T_odom_sensor,
                     whitening_of(drift[i] * step_covariances_[i]), false});
  }
  for (const Loop& loop : loops_) edges.push_back(loop.graph_edge);
  return edges;
}

void PoseGraph::solve() {
  const std::vector<std::uint32_t> group = join_groups(poses_);
  // The first node of each group holds it.
  std::set<std::uint32_t> held;
  std::vector<bool> fixed;
  fixed.reserve(group.size());
  for (const std::uint32_t g : group) fixed.push_back(held.insert(g).second);
  solve_pose_graph(poses_, fixed, edges());
}

std::vector<LoopEdge> PoseGraph::optimize() {
  const std::vector<Pose> before = poses_;
  const auto misfit_of = [&](const Loop& loop) { return chi_squared(loop.graph_edge, poses_); };
  const auto is_settled = [](const Loop& loop) { return loop.settled; };
  std::vector<LoopEdge> refused;
  bool settled = std::ranges::all_of(loops_, is_settled);
  while (!settled) {
    poses_ = before;
    solve();
    const auto worst = std::ranges::max_element(loops_, {}, misfit_of);
    if (worst == loops_.end() || misfit_of(*worst) <= kLargestChiSquared) break;
    const bool was_settled = worst->settled;
    refused.push_back(worst->edge);
    loops_.erase(worst);
    if (was_settled) {
      for (Loop& loop : loops_) loop.settled = false;
    }
    // What the poses were found with is all that is left.
    settled = !was_settled && std::ranges::all_of(loops_, is_settled);
    if (settled) poses_ = before;
  }
  for (Loop& loop : loops_) loop.settled = true;
  return refused;
}

}  // namespace glint::slam
