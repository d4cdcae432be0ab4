// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"
#include "slam/pose_graph_solver.hpp"

namespace glint::slam {

/// A keyframe in the graph. Value type.
struct GraphNode {
  std::uint64_t id = 0;
  std::uint64_t sequence = 0;  ///< Of its scan.
  std::uint32_t segment = 0;
  Pose T_odom_sensor;
};

/// How far a loop edge and the keyframes' present poses are apart.
struct LoopMisfit {
  double distance_m = 0.0;
  double angle_rad = 0.0;
  double chi_squared = 0.0;  ///< Whitened; a right edge has 6 on average.
};

/// Keyframes joined by odometry and by loop closures, and the poses that fit both best. Keyframes
/// of a segment follow one another; segments hold together by loops only, and one that is not
/// joined stays where it was set down. Memory and time grow with the keyframes. Deterministic.
/// Thread-compatible.
class PoseGraph {
 public:
  /// Adds a keyframe, ids rising, where odometry carries the last one's pose: T_map_sensor.
  const Pose& add(const Keyframe& keyframe);
  [[nodiscard]] const std::vector<GraphNode>& nodes() const { return nodes_; }
  /// T_map_sensor of each node.
  [[nodiscard]] std::span<const Pose> poses() const { return poses_; }

  /// Null if a keyframe is not in the graph, or the covariance is none.
  [[nodiscard]] std::optional<LoopMisfit> misfit(const LoopEdge& loop) const;
  /// Both keyframes already hold together, so that the loop's misfit tells something.
  [[nodiscard]] bool joined(const LoopEdge& loop) const;
  /// Adds an edge for which misfit() is not null. Poses stay until optimize().
  void add_loop(const LoopEdge& loop);
  [[nodiscard]] std::size_t loop_count() const { return loops_.size(); }

  /// Finds the poses that fit best. Loops that do not fit the others (chi^2 beyond 95 % of right
  /// ones) are taken out, worst first; returns them. Poses are as if these had never been.
  std::vector<LoopEdge> optimize();

 private:
  struct Loop {
    LoopEdge edge;
    GraphEdge graph_edge;
    double drift_factor = 1.0;  ///< By how much odometry's covariance along it was too small.
    bool settled = false;       ///< The poses are those that optimize() found with it.
  };

  [[nodiscard]] std::optional<std::size_t> find(std::uint64_t id) const;
  [[nodiscard]] std::optional<GraphEdge> graph_edge(const LoopEdge& loop) const;
  [[nodiscard]] double drift_factor(const GraphEdge& loop) const;
  std::vector<std::uint32_t> join_groups(std::span<Pose> poses) const;
  [[nodiscard]] std::vector<GraphEdge> edges() const;
  void solve();

  std::vector<GraphNode> nodes_;
  std::vector<Pose> poses_;
  /// Of the motion from the node before, with what is added for caution; of no meaning for the
  /// first of a segment.
  std::vector<Eigen::Matrix<double, 6, 6>> step_covariances_;
  std::vector<Loop> loops_;
};

}  // namespace glint::slam
