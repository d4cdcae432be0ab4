// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene/bounding_tree.hpp"

#include <algorithm>
#include <limits>

namespace glint::synth {
namespace {

constexpr int kBins = 12;
// From here on the range is halved, so that the tree's depth has a limit.
constexpr int kGreedyDepth = 24;

using Item = BoundingTree::Item;
using Iterator = std::vector<Item>::iterator;

double half_area(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return 0.0;
  const Eigen::Vector3d d = box.diagonal();
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

// Items and their box in a slice of the range.
struct Bin {
  Eigen::AlignedBox3d box;
  int count = 0;
  void add(const Bin& other) {
    box.extend(other.box);
    count += other.count;
  }
  [[nodiscard]] double cost() const { return half_area(box) * count; }
};

// A way to part a range: items whose bin along the axis is below `bin` go first.
struct Cut {
  int axis = 0;
  int bin = 1;
  double cost = std::numeric_limits<double>::infinity();
};

int bin_of(const Item& item, const Eigen::AlignedBox3d& centers, int axis) {
  const double share =
      (item.box.center()[axis] - centers.min()[axis]) / std::max(1e-9, centers.diagonal()[axis]);
  return std::clamp(static_cast<int>(share * kBins), 0, kBins - 1);
}

Cut cheapest_cut(Iterator first, Iterator last, const Eigen::AlignedBox3d& centers, int axis) {
  std::array<Bin, kBins> bins;
  for (auto it = first; it != last; ++it) {
    bins[static_cast<std::size_t>(bin_of(*it, centers, axis))].add({it->box, 1});
  }
  std::array<double, kBins> right_cost{};
  Bin right;
  for (int i = kBins - 1; i > 0; --i) {
    right.add(bins[static_cast<std::size_t>(i)]);
    right_cost[static_cast<std::size_t>(i)] = right.cost();
  }
  Cut best{axis, 1, std::numeric_limits<double>::infinity()};
  Bin left;
  for (int i = 1; i < kBins; ++i) {
    left.add(bins[static_cast<std::size_t>(i - 1)]);
    const double cost = left.cost() + right_cost[static_cast<std::size_t>(i)];
    if (cost < best.cost) best = {axis, i, cost};
  }
  return best;
}

// Orders the range so that it can be parted at the result.
Iterator part(Iterator first, Iterator last) {
  Eigen::AlignedBox3d centers;
  for (auto it = first; it != last; ++it) centers.extend(it->box.center());
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const Cut cut = cheapest_cut(first, last, centers, axis);
    if (cut.cost < best.cost) best = cut;
  }
  const auto middle = std::stable_partition(
      first, last, [&](const Item& item) { return bin_of(item, centers, best.axis) < best.bin; });
  // All in one place: any halves do.
  return middle == first || middle == last ? first + (last - first) / 2 : middle;
}

}  // namespace

BoundingTree::BoundingTree(const std::vector<Item>& items) {
  if (items.empty()) return;
  std::vector<Item> sorted = items;
  build(sorted.begin(), sorted.end(), 0);
}

int BoundingTree::build(Iterator first, Iterator last, int depth) {
  // Parts the largest group until there are four.
  std::vector<std::pair<Iterator, Iterator>> groups = {{first, last}};
  while (groups.size() < kWidth) {
    const auto largest = std::max_element(
        groups.begin(), groups.end(),
        [](const auto& a, const auto& b) { return a.second - a.first < b.second - b.first; });
    const auto [from, to] = *largest;
    if (to - from < 2) break;
    const auto middle = depth < kGreedyDepth ? part(from, to) : from + (to - from) / 2;
    largest->second = middle;
    groups.emplace_back(middle, to);
  }

  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Node node;
  node.count = groups.size();
  for (std::size_t child = 0; child < groups.size(); ++child) {
    const auto [from, to] = groups[child];
    Eigen::AlignedBox3d box;
    for (auto it = from; it != to; ++it) box.extend(it->box);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.min[child][axis] = static_cast<float>(box.min()[static_cast<Eigen::Index>(axis)]);
      node.max[child][axis] = static_cast<float>(box.max()[static_cast<Eigen::Index>(axis)]);
    }
    node.child[child] = to - from == 1 ? ~from->index : build(from, to, depth + 1);
  }
  nodes_[index] = node;
  return static_cast<int>(index);
}

}  // namespace glint::synth
