// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "slam/joint_graph.hpp"
#include "slam/pose_graph.hpp"

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Loops that were taken out and may come back.
constexpr std::size_t kMostAside = 200;

}  // namespace

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

// With what the loops have shown of its drift.
std::vector<Matrix6> PoseGraph::odometry_covariances() const {
  std::vector<double> drift(nodes_.size(), 1.0);
  for (const Loop& loop : loops_) {
    for (std::size_t i = loop.graph_edge.from + 1; i <= loop.graph_edge.to; ++i) {
      drift[i] = std::max(drift[i], loop.drift_factor);
    }
  }
  std::vector<Matrix6> covariances;
  covariances.reserve(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    covariances.emplace_back(drift[i] * step_covariances_[i]);
  }
  return covariances;
}

// The nodes that the solver has to know, in order: ends of loops and of segments, and those that
// felt gravity.
std::vector<std::size_t> PoseGraph::joints() const {
  std::set<std::size_t> joints;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const bool begins = i == 0 || nodes_[i - 1].segment != nodes_[i].segment;
    const bool ends = i + 1 == nodes_.size() || nodes_[i + 1].segment != nodes_[i].segment;
    if (begins || ends) joints.insert(i);
  }
  for (const Loop& loop : loops_) {
    joints.insert(loop.graph_edge.from);
    joints.insert(loop.graph_edge.to);
  }
  for (const GravitySight& sight : sights_) joints.insert(sight.node);
  return {joints.begin(), joints.end()};
}

void PoseGraph::solve() {
  const std::vector<std::uint32_t> group = join_groups(poses_);
  JointGraph graph(nodes_, odometry_covariances(), joints());
  for (const Loop& loop : loops_) graph.add_edge(loop.graph_edge);
  for (const GravityFactor& factor : gravity_factors(group)) graph.add_gravity(factor);
  graph.solve(poses_, group);
}

std::vector<LoopEdge> PoseGraph::optimize() {
  std::vector<LoopEdge> refused;
  restored_.clear();
  if (!all_settled() && has_contradictions() && keep_largest_set(refused)) begin_anew();
  const std::vector<Pose> before = poses_;
  bool settled = all_settled();
  while (!settled) {
    poses_ = before;
    solve();
    const auto worst = std::ranges::max_element(
        loops_, {}, [&](const Loop& loop) { return chi_squared(loop.graph_edge, poses_); });
    if (worst == loops_.end() || chi_squared(worst->graph_edge, poses_) <= kLargestChiSquared) {
      break;
    }
    const bool was_settled = worst->settled;
    refuse(static_cast<std::size_t>(worst - loops_.begin()), refused);
    if (was_settled) unsettle();
    // What the poses were found with is all that is left.
    settled = !was_settled && all_settled();
    if (settled) poses_ = before;
  }
  for (Loop& loop : loops_) loop.settled = true;
  tilted_ = false;
  return refused;
}

bool PoseGraph::all_settled() const {
  return !tilted_ && std::ranges::all_of(loops_, [](const Loop& loop) { return loop.settled; });
}

void PoseGraph::unsettle() {
  for (Loop& loop : loops_) loop.settled = false;
}

void PoseGraph::refuse(std::size_t index, std::vector<LoopEdge>& refused) {
  const auto at = loops_.begin() + static_cast<std::ptrdiff_t>(index);
  const auto is_it = [&](const LoopEdge& edge) {
    return edge.from == at->edge.from && edge.to == at->edge.to;
  };
  if (std::erase_if(restored_, is_it) == 0) refused.push_back(at->edge);
  at->settled = false;
  if (options_.loop_consistency) aside_.push_back(std::move(*at));
  if (aside_.size() > kMostAside) aside_.erase(aside_.begin());
  loops_.erase(at);
}

bool PoseGraph::has_contradictions() const {
  return std::ranges::any_of(loops_, [](const Loop& loop) { return !loop.against.empty(); });
}

// Of loops that are in and those that are set aside. True where settled ones had to go.
bool PoseGraph::keep_largest_set(std::vector<LoopEdge>& refused) {
  const std::vector<bool> keep = largest_agreeing(votes());
  const std::size_t in_count = loops_.size();
  std::vector<Loop> back;
  for (std::size_t i = keep.size(); i-- > in_count;) {
    if (!keep[i]) continue;
    const auto at = aside_.begin() + static_cast<std::ptrdiff_t>(i - in_count);
    back.push_back(std::move(*at));
    aside_.erase(at);
  }
  bool settled_one_went = false;
  for (std::size_t i = in_count; i-- > 0;) {
    if (keep[i]) continue;
    settled_one_went |= loops_[i].settled;
    refuse(i, refused);
  }
  for (Loop& loop : back) {
    restored_.push_back(loop.edge);
    loops_.push_back(std::move(loop));
  }
  std::ranges::sort(loops_, {}, &Loop::number);
  return settled_one_went;
}

std::vector<LoopVote> PoseGraph::votes() const {
  std::map<std::uint64_t, std::size_t> place;
  for (const auto* loops : {&loops_, &aside_}) {
    for (const Loop& loop : *loops) place.emplace(loop.number, place.size());
  }
  std::vector<LoopVote> votes;
  for (const auto* loops : {&loops_, &aside_}) {
    for (const Loop& loop : *loops) {
      LoopVote& vote = votes.emplace_back();
      vote.settled = loop.settled;
      vote.set_aside = loops == &aside_;
      for (const std::uint64_t number : loop.against) {
        const auto at = place.find(number);
        if (at != place.end()) vote.against.push_back(at->second);
      }
    }
  }
  return votes;
}

// The poses were bent by what has turned out to be wrong: back to those of odometry, against which
// the loops that are left show its drift.
void PoseGraph::begin_anew() {
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    poses_[i] = poses_[i - 1] * (nodes_[i - 1].T_odom_sensor.inverse() * nodes_[i].T_odom_sensor);
  }
  for (Loop& loop : loops_) loop.drift_factor = drift_factor(loop.graph_edge);
  unsettle();
}

}  // namespace glint::slam
