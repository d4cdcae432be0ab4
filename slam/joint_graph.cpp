// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/joint_graph.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace glint::slam {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

JointGraph::JointGraph(std::span<const GraphNode> nodes, std::span<const Matrix6> step_covariances,
                       std::vector<std::size_t> joints)
    : joints_(std::move(joints)), chains_(joints_.size()) {
  std::vector<Pose> T_odom;
  T_odom.reserve(nodes.size());
  for (const GraphNode& node : nodes) T_odom.push_back(node.T_odom_sensor);
  for (std::size_t k = 1; k < joints_.size(); ++k) {
    const std::size_t from = joints_[k - 1];
    if (nodes[from].segment != nodes[joints_[k]].segment) continue;
    const std::size_t count = joints_[k] - from + 1;
    const OdometryChain& chain = chains_[k].emplace(std::span(T_odom).subspan(from, count),
                                                    step_covariances.subspan(from, count));
    edges_.push_back({k - 1, k, chain.edge(), whitening_of(chain.covariance())});
  }
}

void JointGraph::add_edge(GraphEdge edge) {
  edge.from = number_of(edge.from);
  edge.to = number_of(edge.to);
  edges_.push_back(edge);
}

void JointGraph::add_gravity(GravityFactor factor) {
  factor.node = number_of(factor.node);
  gravity_.push_back(factor);
}

std::size_t JointGraph::number_of(std::size_t node) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(joints_, node) - joints_.begin());
}

void JointGraph::solve(std::span<Pose> poses, std::span<const std::uint32_t> group) const {
  std::vector<Pose> joint_poses;
  joint_poses.reserve(joints_.size());
  for (const std::size_t joint : joints_) joint_poses.push_back(poses[joint]);
  solve_pose_graph(joint_poses, held_joints(group), edges_, gravity_);
  spread(joint_poses, poses);
}

std::vector<bool> JointGraph::held_joints(std::span<const std::uint32_t> group) const {
  std::vector<bool> held;
  std::set<std::uint32_t> groups;
  for (const std::size_t joint : joints_) held.push_back(groups.insert(group[joint]).second);
  return held;
}

void JointGraph::spread(std::span<const Pose> joint_poses, std::span<Pose> poses) const {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    poses[joints_[k]] = joint_poses[k];
    if (!chains_[k]) continue;
    const std::size_t from = joints_[k - 1];
    chains_[k]->spread(poses.subspan(from, joints_[k] - from + 1));
  }
}

}  // namespace glint::slam
