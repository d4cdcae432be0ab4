// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/graph_node.hpp"
#include "slam/odometry_chain.hpp"
#include "slam/pose_graph_solver.hpp"

namespace glint::slam {

/// The pose graph as the solver gets it: of the keyframes only the joints, which something else
/// than odometry knows of, and odometry's chains between them. Thread-compatible; deterministic.
class JointGraph {
 public:
  /// `step_covariances`: of the motion to each node from the one before, right perturbation.
  /// `joints`: rising; the first and the last node of each segment are among them.
  JointGraph(std::span<const GraphNode> nodes,
             std::span<const Eigen::Matrix<double, 6, 6>> step_covariances,
             std::vector<std::size_t> joints);

  /// Both number their nodes as the constructor does; they have to be joints.
  void add_edge(GraphEdge edge);
  void add_gravity(GravityFactor factor);

  /// Moves all poses to what fits best. The first node of each group stays.
  void solve(std::span<Pose> poses, std::span<const std::uint32_t> group) const;

 private:
  [[nodiscard]] std::size_t number_of(std::size_t node) const;
  [[nodiscard]] std::vector<bool> held_joints(std::span<const std::uint32_t> group) const;
  void spread(std::span<const Pose> joint_poses, std::span<Pose> poses) const;

  std::vector<std::size_t> joints_;
  std::vector<std::optional<OdometryChain>> chains_;  ///< To each joint from that before.
  std::vector<GraphEdge> edges_;                      ///< Between joints.
  std::vector<GravityFactor> gravity_;
};

}  // namespace glint::slam
