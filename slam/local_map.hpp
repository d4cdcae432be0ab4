// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/inc_kd_tree.hpp"
#include "slam/joint_terms.hpp"

namespace glint::slam {

struct LocalMapOptions {
  /// Map points that give a plane: 3 (the paper) spans it, 4 to 8 are fitted by least squares.
  int neighbours = 3;
  double largest_distance_m = 1.0;  ///< Of a neighbour.
  /// Three points span a plane when twice their triangle's area is at least this share of their
  /// longest side squared: the nearest ones often lie on one ring.
  double least_spread = 0.1;
  double largest_misfit_m = 0.1;  ///< Of a neighbour to the fitted plane.
  double largest_residual_m = 0.5;
  double voxel_m = 0.4;     ///< The map keeps one point in each.
  double radius_m = 100.0;  ///< Points farther from the sensor along an axis are let go.
  double ground_weight = 2.0;
};

/// The surfaces around the sensor, ground apart from all others, as points in two incremental k-d
/// trees; odometry frame. Thread-compatible.
class LocalMap {
 public:
  explicit LocalMap(LocalMapOptions options);

  /// The plane terms of a scan seen from about T_odom_scan; the first `ground_count` points are on
  /// the ground. Points without a plane near them give none.
  void associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                 const Pose& T_odom_scan, std::vector<PlaneTerm>& terms);
  /// The same as associate() for the points that it last had, from a pose somewhat off that one.
  /// Faster: most nearest points are still among those found then. Not after add().
  void associate_again(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                       const Pose& T_odom_scan, std::vector<PlaneTerm>& terms);
  /// Adds a scan's points and lets go what is far from it.
  void add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
           const Pose& T_odom_scan);
  void clear();
  [[nodiscard]] std::size_t size() const { return ground_.size() + general_.size(); }

  /// A large subtree to be rebuilt by the back end, see IncKdTree.
  struct Rebuild {
    bool of_ground = false;
    IncKdTree::Rebuild tree;
  };
  [[nodiscard]] std::optional<Rebuild> take_rebuild();
  void adopt(Rebuild&& rebuild);

 private:
  /// What the tree has near a place that was looked up; more than planes need.
  struct Lookup {
    Eigen::Vector3f place_m;
    Neighbours near;
  };

  [[nodiscard]] int neighbours_wanted() const;
  [[nodiscard]] Neighbours near_again(const Lookup& lookup, const IncKdTree& tree,
                                      const Eigen::Vector3f& place_m) const;
  void add_term(const Eigen::Vector3f& point_m, bool ground, const Eigen::Vector3d& place_m,
                const Neighbours& near, std::vector<PlaneTerm>& terms) const;
  [[nodiscard]] const IncKdTree& tree_of(bool ground) const { return ground ? ground_ : general_; }
  [[nodiscard]] std::optional<PlaneTerm> spanned(const Neighbours& near) const;
  [[nodiscard]] std::optional<PlaneTerm> fitted(const Neighbours& near) const;

  LocalMapOptions options_;
  IncKdTree ground_;
  IncKdTree general_;
  std::optional<Eigen::Vector3d> kept_around_m_;
  std::vector<Lookup> lookups_;  // by associate()'s points
};

}  // namespace glint::slam
