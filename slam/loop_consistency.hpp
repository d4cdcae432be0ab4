// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/graph_node.hpp"
#include "slam/pose_graph_solver.hpp"

namespace glint::slam {

/// Tells whether two loops can both be true: from the one's keyframes to the other's the way is
/// known by odometry, and round the two ways and the two loops one has to come back to where one
/// began, as exactly as their covariances say [Mangelson 2018, "Pairwise consistent measurement set
/// maximization for robust multi-robot map merging", sec. IV]. Thread-compatible.
class LoopConsistency {
 public:
  /// The next node; `step_covariance` of the motion to it from the one before.
  void add(const GraphNode& node, const Eigen::Matrix<double, 6, 6>& step_covariance);
  /// Whether `a` and `b`, whose covariances are those of their T_from_to, contradict each other.
  /// Where odometry knows no way between them, or a long one, nothing is said against them. The
  /// time does not grow with the way.
  [[nodiscard]] bool contradict(const GraphEdge& a, const GraphEdge& b) const;

 private:
  struct Station {
    std::uint32_t segment = 0;
    double path_m = 0.0;
    Pose T_odom_sensor;
    /// Of all steps so far, left perturbation: what lies between two stations is the difference.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  };
  [[nodiscard]] bool near(std::size_t a, std::size_t b) const;
  [[nodiscard]] Eigen::Matrix<double, 6, 6> covariance_between(std::size_t a, std::size_t b) const;

  std::vector<Station> stations_;
};

/// What is decided about one of several loops.
struct LoopVote {
  std::vector<std::size_t> against;  ///< The numbers of those that it contradicts.
  bool settled = false;              ///< The poses rest on it: of two equal sets this one's stays.
  bool set_aside = false;            ///< It was refused before.
};

/// Which loops to keep: about the largest set of which no two contradict each other, found by
/// taking the one with the fewest contradictions again and again. A loop that was set aside comes
/// back only as part of a set that overthrows settled ones. Time quadratic in the loops.
/// Deterministic.
std::vector<bool> largest_agreeing(std::span<const LoopVote> loops);

}  // namespace glint::slam
