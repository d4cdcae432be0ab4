// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/bounding_tree.hpp"

#include <algorithm>
#include <numeric>

namespace glint::synth {

BoundingTree::BoundingTree(const std::vector<Eigen::AlignedBox3d>& boxes) {
  if (boxes.empty()) return;
  std::vector<int> items(boxes.size());
  std::iota(items.begin(), items.end(), 0);
  nodes_.reserve(2 * boxes.size());
  build(boxes, items.begin(), items.end());
}

int BoundingTree::build(const std::vector<Eigen::AlignedBox3d>& boxes,
                        std::vector<int>::iterator first, std::vector<int>::iterator last) {
  const auto box_of = [&](int item) -> const Eigen::AlignedBox3d& {
    return boxes[static_cast<std::size_t>(item)];
  };
  const int index = static_cast<int>(nodes_.size());
  Node node;
  Eigen::AlignedBox3d centers;
  for (auto it = first; it != last; ++it) {
    node.box.extend(box_of(*it));
    centers.extend(box_of(*it).center());
  }
  if (last - first == 1) node.item = *first;
  centers.diagonal().maxCoeff(&node.axis);
  const int axis = node.axis;
  nodes_.push_back(node);
  if (node.item >= 0) return index;

  const auto middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [&](int a, int b) {
    const double at_a = box_of(a).center()[axis];
    const double at_b = box_of(b).center()[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  build(boxes, first, middle);
  const int second_child = build(boxes, middle, last);
  nodes_[static_cast<std::size_t>(index)].second_child = second_child;
  return index;
}

}  // namespace glint::synth
