// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace glint::synth {

/// Rays that go side by side: what they have in common is worked out once. Cast anything less as
/// copies of one ray.
constexpr int kPacketRays = 4;

/// A tree of axis-aligned boxes, four to a node, that tells which of many items rays may hit.
/// Built by the surface area heuristic (Wald, "On fast construction of SAH-based bounding volume
/// hierarchies", 2007). Boxes are kept in single precision: give them a margin. Immutable;
/// thread-safe.
class BoundingTree {
 public:
  /// A number for each ray, which the compiler keeps in one register.
  using Lanes [[gnu::vector_size(kPacketRays * sizeof(float))]] = float;
  /// Rays as boxes are tested against: component by component.
  struct Packet {
    std::array<Lanes, 3> origin_m;
    std::array<Lanes, 3> inverse_direction;
  };
  struct Item {
    Eigen::AlignedBox3d box;
    int index = 0;
  };

  /// An item may have several boxes that cover it together.
  explicit BoundingTree(const std::vector<Item>& items);

  /// Calls visit(index) for every item whose box any of the rays enters before its limit; visit may
  /// lower `limits_m`. Nearer boxes come first.
  template <class Visit>
  void walk(const Packet& packet, const Lanes& limits_m, Visit&& visit) const;

 private:
  static constexpr std::size_t kWidth = 4;
  /// The boxes of up to four children, and what they are: another node, or ~index.
  struct Node {
    std::array<std::array<float, 3>, kWidth> min;
    std::array<std::array<float, 3>, kWidth> max;
    std::array<int, kWidth> child;
    std::size_t count = 0;
  };
  struct Entry {
    Lanes from_m;
    int child;
  };
  using Iterator = std::vector<Item>::iterator;

  int build(Iterator first, Iterator last, int depth);

  static Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
  static Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
  /// Whether any ray enters before it leaves.
  static bool any(const Lanes& from, const Lanes& to) {
    const auto inside = std::bit_cast<std::array<std::uint64_t, 2>>(from <= to);
    return (inside[0] | inside[1]) != 0;
  }

  static constexpr std::size_t kStack = 256;
  std::vector<Node> nodes_;
};

template <class Visit>
void BoundingTree::walk(const Packet& packet, const Lanes& limits_m, Visit&& visit) const {
  if (nodes_.empty()) return;
  // Stack of what is still to be looked at; the nearest child of each node lies on top.
  std::array<Entry, kStack> stack;
  std::size_t depth = 0;
  stack[depth++] = {Lanes{}, 0};
  while (depth > 0) {
    const Entry& entry = stack[--depth];
    const int top = entry.child;
    if (!any(entry.from_m, limits_m)) continue;
    if (top < 0) {
      visit(~top);
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(top)];
    const std::size_t base = depth;
    for (std::size_t child = 0; child < node.count; ++child) {
      Lanes from{};
      Lanes to = limits_m;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Lanes a =
            (node.min[child][axis] - packet.origin_m[axis]) * packet.inverse_direction[axis];
        const Lanes b =
            (node.max[child][axis] - packet.origin_m[axis]) * packet.inverse_direction[axis];
        from = larger(from, smaller(a, b));
        to = smaller(to, larger(a, b));
      }
      if (!any(from, to)) continue;
      std::size_t at = depth++;
      for (; at > base && stack[at - 1].from_m[0] < from[0]; --at) stack[at] = stack[at - 1];
      stack[at] = {from, node.child[child]};
    }
  }
}

}  // namespace glint::synth
