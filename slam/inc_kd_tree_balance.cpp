// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How an IncKdTree keeps its balance.
#include <algorithm>
#include <utility>

#include "slam/inc_kd_tree.hpp"

namespace glint::slam {
namespace {

// Smaller subtrees are searched as fast out of balance.
constexpr std::int32_t kSmallestRebuild = 10;

// Which points lie to the left of an axis' median; the other axes settle ties, so that the tree
// follows from the set of points.
struct LeftOf {
  int axis;
  bool operator()(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
    for (int step = 0; step < 3; ++step) {
      const int i = (axis + step) % 3;
      if (a[i] != b[i]) return a[i] < b[i];
    }
    return false;
  }
};

}  // namespace

bool IncKdTree::unbalanced(const Node& node) const {
  if (node.size < kSmallestRebuild) return false;
  const std::int32_t left = node.left == kNone ? 0 : at(node.left).size;
  const std::int32_t larger = std::max(left, node.size - 1 - left);
  return larger > options_.balance * (node.size - 1) ||
         node.deleted_count > options_.deleted * node.size;
}

// After an insertion: of the unbalanced subtrees around the leaf the largest that may be rebuilt
// at once.
void IncKdTree::mend_above(Index leaf) {
  Index worst = kNone;
  for (Index i = leaf; i != kNone && at(i).size <= options_.largest_inline_rebuild;
       i = at(i).parent) {
    if (unbalanced(at(i))) worst = i;
  }
  if (worst != kNone) rebuild_here(worst);
}

// After deletions, which may have hit many places.
void IncKdTree::mend_below(Index root) {
  if (root == kNone || at(root).deleted_count == 0) return;
  const bool small = at(root).size <= options_.largest_inline_rebuild;
  const bool gone = at(root).deleted_count == at(root).size;
  if ((gone || (small && unbalanced(at(root)))) && rebuild_here(root)) return;
  push_down(root);
  const auto [left, right] = std::pair(at(root).left, at(root).right);
  mend_below(left);
  mend_below(right);
}

// False for one that holds the subtree which is being rebuilt elsewhere.
bool IncKdTree::rebuild_here(Index root) {
  if (being_rebuilt_ != kNone && lies_below(being_rebuilt_, root)) return false;
  const Index parent = at(root).parent;
  points_.clear();
  free_subtree(root, &points_);
  built_.clear();
  build(points_, 0, points_.size(), kNone, built_);
  replace_child(parent, root, graft(built_, parent));
  pull_up_to_root(parent);
  return true;
}

IncKdTree::Index IncKdTree::build(std::vector<Eigen::Vector3f>& points, std::size_t begin,
                                  std::size_t end, Index parent, std::vector<Node>& nodes) {
  if (begin == end) return kNone;
  Box box;
  for (std::size_t i = begin; i < end; ++i) box.extend(points[i]);
  int axis = 0;
  (box.max_m - box.min_m).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at_place = [&](std::size_t i) {
    return points.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at_place(begin), at_place(middle), at_place(end), LeftOf{axis});

  const auto me = static_cast<Index>(nodes.size());
  Node& node = nodes.emplace_back();
  node.point = points[middle];
  node.box = box;
  node.parent = parent;
  node.size = static_cast<std::int32_t>(end - begin);
  node.axis = static_cast<std::uint8_t>(axis);
  const Index left = build(points, begin, middle, me, nodes);
  const Index right = build(points, middle + 1, end, me, nodes);
  nodes[static_cast<std::size_t>(me)].left = left;
  nodes[static_cast<std::size_t>(me)].right = right;
  return me;
}

// Puts a tree that was built by itself below a node; its root's place, or none.
IncKdTree::Index IncKdTree::graft(const std::vector<Node>& nodes, Index parent) {
  grafted_.clear();
  for (const Node& node : nodes) grafted_.push_back(add_node(node.point, kNone, node.axis));
  const auto moved = [&](Index i) {
    return i == kNone ? kNone : grafted_[static_cast<std::size_t>(i)];
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Node& node = at(grafted_[i]);
    node = nodes[i];
    node.left = moved(node.left);
    node.right = moved(node.right);
    node.parent = i == 0 ? parent : moved(node.parent);
  }
  return nodes.empty() ? kNone : grafted_.front();
}

void IncKdTree::Rebuild::run() {
  nodes_.clear();
  nodes_.reserve(points_.size());
  build(points_, 0, points_.size(), kNone, nodes_);
}

std::optional<IncKdTree::Rebuild> IncKdTree::take_rebuild() {
  if (being_rebuilt_ != kNone) return std::nullopt;
  const Index root = find_large_unbalanced(root_);
  if (root == kNone) return std::nullopt;
  being_rebuilt_ = root;
  log_.clear();
  Rebuild rebuild;
  rebuild.points_.reserve(static_cast<std::size_t>(at(root).size - at(root).deleted_count));
  collect_below(root, at(root).box, rebuild.points_);
  rebuild.ticket_ = ++ticket_;
  return rebuild;
}

IncKdTree::Index IncKdTree::find_large_unbalanced(Index root) const {
  if (root == kNone || at(root).size <= options_.largest_inline_rebuild) return kNone;
  if (at(root).deleted_count == at(root).size) return kNone;
  if (unbalanced(at(root))) return root;
  const Index left = find_large_unbalanced(at(root).left);
  return left != kNone ? left : find_large_unbalanced(at(root).right);
}

void IncKdTree::adopt(Rebuild&& rebuild) {
  const Rebuild taken = std::move(rebuild);
  if (being_rebuilt_ == kNone || taken.ticket_ != ticket_) return;
  const Index former = std::exchange(being_rebuilt_, kNone);
  const Index parent = at(former).parent;
  free_subtree(former, nullptr);
  Index root = graft(taken.nodes_, parent);
  for (const LogEntry& entry : log_) {
    root = replay(root, entry);
    if (root != kNone) at(root).parent = parent;
  }
  log_.clear();
  replace_child(parent, former, root);
  pull_up_to_root(parent);
}

void IncKdTree::log(LogEntry entry) {
  if (being_rebuilt_ != kNone) log_.push_back(std::move(entry));
}

// The subtree's root afterwards.
IncKdTree::Index IncKdTree::replay(Index root, const LogEntry& entry) {
  using Kind = LogEntry::Kind;
  if (entry.kind == Kind::kInsert) {
    if (root == kNone) return add_node(entry.point, kNone, 0);
    insert_below(root, entry.point);
    return root;
  }
  if (entry.kind == Kind::kErasePoint) erase_point_below(root, entry.point);
  if (entry.kind == Kind::kErase) erase_below(root, entry.box);
  if (entry.kind == Kind::kKeep) keep_below(root, entry.box);
  return root;
}

}  // namespace glint::slam
