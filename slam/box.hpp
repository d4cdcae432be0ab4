// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <limits>

namespace glint::slam {

/// An axis-aligned box, borders included, m. Empty as made. Value type.
struct Box {
  Eigen::Vector3f min_m = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector3f max_m = Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity());

  void extend(const Eigen::Vector3f& p) {
    min_m = min_m.cwiseMin(p);
    max_m = max_m.cwiseMax(p);
  }
  void extend(const Box& other) {
    min_m = min_m.cwiseMin(other.min_m);
    max_m = max_m.cwiseMax(other.max_m);
  }
  [[nodiscard]] bool contains(const Eigen::Vector3f& p) const {
    return (p.array() >= min_m.array()).all() && (p.array() <= max_m.array()).all();
  }
  [[nodiscard]] bool contains(const Box& other) const {
    return (other.min_m.array() >= min_m.array()).all() &&
           (other.max_m.array() <= max_m.array()).all();
  }
  [[nodiscard]] bool touches(const Box& other) const {
    return (other.min_m.array() <= max_m.array()).all() &&
           (other.max_m.array() >= min_m.array()).all();
  }
  /// Squared distance of a point to the box, 0 inside.
  [[nodiscard]] float squared_distance(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f outside = (min_m - p).cwiseMax(p - max_m).cwiseMax(0.0F);
    return outside.squaredNorm();
  }
};

}  // namespace glint::slam
