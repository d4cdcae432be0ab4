// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

namespace glint::synth {

/// A binary tree of axis-aligned boxes that tells which of many items a ray may hit. Immutable.
class BoundingTree {
 public:
  explicit BoundingTree(const std::vector<Eigen::AlignedBox3d>& boxes);

  /// Calls visit(item) for every item whose box the ray enters before the distance that visit last
  /// returned; visit returns the distance (m) that is still of interest. Nearer boxes come first.
  template <class Visit>
  void walk(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction, Visit&& visit) const;

 private:
  /// A leaf holds one item; an inner node's first child follows it.
  struct Node {
    Eigen::AlignedBox3d box;
    int second_child = -1;
    int item = -1;  ///< -1 for an inner node.
    int axis = 0;   ///< Along which the children are ordered.
  };

  int build(const std::vector<Eigen::AlignedBox3d>& boxes, std::vector<int>::iterator first,
            std::vector<int>::iterator last);
  static bool enters(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin_m,
                     const Eigen::Vector3d& inverse, double limit_m) {
    const Eigen::Array3d a = (box.min() - origin_m).array() * inverse.array();
    const Eigen::Array3d b = (box.max() - origin_m).array() * inverse.array();
    const double from_m = a.min(b).maxCoeff();
    const double to_m = a.max(b).minCoeff();
    return from_m <= to_m && to_m >= 0.0 && from_m < limit_m;
  }

  static constexpr std::size_t kMaxDepth = 64;
  std::vector<Node> nodes_;
};

template <class Visit>
void BoundingTree::walk(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction,
                        Visit&& visit) const {
  if (nodes_.empty()) return;
  // No component is exactly zero, or a flat box would give 0 * infinity.
  const Eigen::Vector3d inverse =
      direction.unaryExpr([](double d) { return 1.0 / (std::abs(d) < 1e-12 ? 1e-12 : d); });
  double limit_m = std::numeric_limits<double>::infinity();
  std::array<int, kMaxDepth> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int index = stack[--depth];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!enters(node.box, origin_m, inverse, limit_m)) continue;
    if (node.item >= 0) {
      limit_m = visit(node.item);
      continue;
    }
    const bool backwards = direction[node.axis] < 0.0;
    stack[depth++] = backwards ? index + 1 : node.second_child;
    stack[depth++] = backwards ? node.second_child : index + 1;
  }
}

}  // namespace glint::synth
