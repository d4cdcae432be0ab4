// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "driver/core/time.hpp"
#include "slam/graph_node.hpp"
#include "slam/gravity_factor.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_consistency.hpp"
#include "slam/loop_edge.hpp"
#include "slam/pose_graph_solver.hpp"

namespace glint::slam {

/// How far a loop edge and the keyframes' present poses are apart.
struct LoopMisfit {
  double distance_m = 0.0;
  double angle_rad = 0.0;
  double chi_squared = 0.0;  ///< Whitened; a right edge has 6 on average.
};

struct PoseGraphOptions {
  /// Keyframes' roll and pitch follow what they felt of gravity.
  bool gravity = true;
  /// Of loops that contradict one another the largest set that agrees is kept.
  bool loop_consistency = true;
};

/// Keyframes joined by odometry and by loop closures, and the poses that fit both best. Keyframes
/// of a segment follow one another; segments hold together by loops only, and one that is not
/// joined stays where it was set down. Memory and time grow with the keyframes. Deterministic.
/// Thread-compatible.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphOptions& options = {}) : options_(options) {}

  /// Adds a keyframe, ids rising, where odometry carries the last one's pose: T_map_sensor.
  const Pose& add(const Keyframe& keyframe);
  /// The same for one that is known to be at T_map_sensor: the first of a segment, or one of a
  /// session that is gone on with.
  void add_at(const Keyframe& keyframe, const Pose& T_map_sensor);
  /// A loop of such a session, with which its poses were found. Nothing happens if its keyframes or
  /// its covariance are none.
  void restore_loop(const LoopEdge& loop);
  [[nodiscard]] const std::vector<GraphNode>& nodes() const { return nodes_; }
  /// T_map_sensor of each node.
  [[nodiscard]] std::span<const Pose> poses() const { return poses_; }

  /// T_map_sensor of a keyframe. Null if it is none of the graph's.
  [[nodiscard]] std::optional<Pose> pose(std::uint64_t id) const;
  /// Where odometry carries the last one's pose to, as add() would have it.
  [[nodiscard]] Pose next(const Keyframe& keyframe) const;

  /// Null if a keyframe is not in the graph, or the covariance is none.
  [[nodiscard]] std::optional<LoopMisfit> misfit(const LoopEdge& loop) const;
  /// Both keyframes already hold together, so that the loop's misfit tells something.
  [[nodiscard]] bool joined(const LoopEdge& loop) const;
  /// Adds an edge for which misfit() is not null. Poses stay until optimize().
  void add_loop(const LoopEdge& loop);
  [[nodiscard]] std::size_t loop_count() const { return loops_.size(); }
  /// The edges that are in, in order of their arrival.
  [[nodiscard]] std::vector<LoopEdge> loops() const;
  /// A number for each node; those that hold together have the same.
  [[nodiscard]] std::vector<std::uint32_t> groups() const;

  /// The last keyframe stands askew by what it felt of gravity: optimize() is worth while.
  [[nodiscard]] bool tilted() const { return tilted_; }

  /// Finds the poses that fit best. Loops that do not fit the others (chi^2 beyond 95 % of right
  /// ones) are taken out and returned: all that a larger set which agrees contradicts, then the
  /// worst ones. Poses are as if these had never been.
  std::vector<LoopEdge> optimize();
  /// Loops that were taken out before, and that the last optimize() took back: what stood against
  /// them has turned out to be wrong.
  [[nodiscard]] const std::vector<LoopEdge>& restored() const { return restored_; }

 private:
  struct Loop {
    LoopEdge edge;
    GraphEdge graph_edge;
    double drift_factor = 1.0;  ///< By how much odometry's covariance along it was too small.
    bool settled = false;       ///< The poses are those that optimize() found with it.
    std::uint64_t number = 0;   ///< By order of arrival.
    std::vector<std::uint64_t> against;  ///< The numbers of loops that it contradicts.
  };
  struct GravitySight {
    SensorTime stamp;
    std::uint32_t segment = 0;
    std::size_t node = 0;
    FeltGravity felt;
  };

  [[nodiscard]] std::optional<std::size_t> find(std::uint64_t id) const;
  [[nodiscard]] std::optional<GraphEdge> graph_edge(const LoopEdge& loop) const;
  [[nodiscard]] double drift_factor(const GraphEdge& loop) const;
  std::vector<std::uint32_t> join_groups(std::span<Pose> poses) const;
  [[nodiscard]] std::vector<Eigen::Matrix<double, 6, 6>> odometry_covariances() const;
  [[nodiscard]] std::vector<std::size_t> joints() const;
  void solve();

  void take_gravity(const Keyframe& keyframe);
  [[nodiscard]] std::vector<GravityFactor> gravity_factors(
      std::span<const std::uint32_t> group) const;
  void note_contradictions(Loop& loop);
  [[nodiscard]] std::vector<LoopVote> votes() const;
  [[nodiscard]] bool has_contradictions() const;
  bool keep_largest_set(std::vector<LoopEdge>& refused);
  void refuse(std::size_t index, std::vector<LoopEdge>& refused);
  void begin_anew();
  void unsettle();
  [[nodiscard]] bool all_settled() const;

  const PoseGraphOptions options_;
  std::vector<GraphNode> nodes_;
  std::vector<Pose> poses_;
  /// Of the motion from the node before, with what is added for caution; of no meaning for the
  /// first of a segment.
  std::vector<Eigen::Matrix<double, 6, 6>> step_covariances_;
  std::vector<Loop> loops_;
  std::vector<Loop> aside_;  ///< That were taken out: the last ones, oldest first.
  std::vector<LoopEdge> restored_;
  std::uint64_t next_loop_ = 0;
  LoopConsistency consistency_;
  std::vector<GravitySight> sights_;
  bool tilted_ = false;
};

}  // namespace glint::slam
