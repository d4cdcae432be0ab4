// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/inc_kd_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

Eigen::Vector3i cube_of(const Eigen::Vector3f& point, float edge_m) {
  return (point / edge_m).array().floor().cast<int>();
}

Eigen::Vector3f middle_of(const Eigen::Vector3i& cube, float edge_m) {
  return (cube.cast<float>() + Eigen::Vector3f::Constant(0.5F)) * edge_m;
}

}  // namespace

// ---- insertion and deletion -----------------------------------------------------------------

void IncKdTree::insert(const Eigen::Vector3f& point) {
  if (root_ == kNone) {
    root_ = add_node(point, kNone, 0);
    return;
  }
  const Index leaf = insert_below(root_, point);
  if (being_rebuilt_ != kNone && lies_below(leaf, being_rebuilt_)) {
    log({LogEntry::Kind::kInsert, point, {}});
  }
  mend_above(leaf);
}

bool IncKdTree::insert_downsampled(const Eigen::Vector3f& point) {
  const Eigen::Vector3i cube = cube_of(point, options_.voxel_m);
  const Eigen::Vector3f middle = middle_of(cube, options_.voxel_m);
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(0.51F * options_.voxel_m);
  in_cube_.clear();
  collect({middle - half, middle + half}, in_cube_);
  // The box is a little too large, for rounding must not lose what lies on the cube's border.
  std::erase_if(in_cube_,
                [&](const auto& other) { return cube_of(other, options_.voxel_m) != cube; });
  const float distance_m = (point - middle).norm();
  for (const Eigen::Vector3f& other : in_cube_) {
    if ((other - middle).norm() <= distance_m + options_.margin_m) return false;
  }
  for (const Eigen::Vector3f& other : in_cube_) {
    erase_point_below(root_, other);
    log({LogEntry::Kind::kErasePoint, other, {}});
  }
  insert(point);
  return true;
}

void IncKdTree::erase(const Box& box) {
  if (root_ == kNone) return;
  erase_below(root_, box);
  log({LogEntry::Kind::kErase, {}, box});
  mend_below(root_);
}

void IncKdTree::keep(const Box& box) {
  if (root_ == kNone) return;
  keep_below(root_, box);
  log({LogEntry::Kind::kKeep, {}, box});
  mend_below(root_);
}

void IncKdTree::clear() {
  nodes_.clear();
  free_.clear();
  root_ = being_rebuilt_ = kNone;
  ++ticket_;
  log_.clear();
}

// The new leaf.
IncKdTree::Index IncKdTree::insert_below(Index root, const Eigen::Vector3f& point) {
  Index i = root;
  for (;;) {
    push_down(i);
    Node& node = at(i);
    ++node.size;
    node.box.extend(point);
    const bool left = point[node.axis] < node.point[node.axis];
    const Index child = left ? node.left : node.right;
    if (child != kNone) {
      i = child;
      continue;
    }
    const auto axis = static_cast<std::uint8_t>((node.axis + 1) % 3);
    const Index leaf = add_node(point, i, axis);  // may move the nodes
    (left ? at(i).left : at(i).right) = leaf;
    return leaf;
  }
}

bool IncKdTree::erase_point_below(Index root, const Eigen::Vector3f& point) {
  if (root == kNone || at(root).deleted_count == at(root).size) return false;
  if (!at(root).box.contains(point)) return false;
  push_down(root);
  Node& node = at(root);
  bool erased = !node.deleted && node.point == point;
  if (erased) node.deleted = true;
  // Equal coordinates may lie on both sides.
  erased = erased || erase_point_below(node.left, point) || erase_point_below(node.right, point);
  if (erased) ++node.deleted_count;
  return erased;
}

void IncKdTree::erase_below(Index root, const Box& box) {
  if (root == kNone || at(root).deleted_count == at(root).size) return;
  if (!box.touches(at(root).box)) return;
  if (box.contains(at(root).box)) return delete_all(root);
  push_down(root);
  Node& node = at(root);
  if (box.contains(node.point)) node.deleted = true;
  erase_below(node.left, box);
  erase_below(node.right, box);
  pull_up(root);
}

void IncKdTree::keep_below(Index root, const Box& box) {
  if (root == kNone || at(root).deleted_count == at(root).size) return;
  if (box.contains(at(root).box)) return;
  if (!box.touches(at(root).box)) return delete_all(root);
  push_down(root);
  Node& node = at(root);
  if (!box.contains(node.point)) node.deleted = true;
  keep_below(node.left, box);
  keep_below(node.right, box);
  pull_up(root);
}

// ---- nodes ----------------------------------------------------------------------------------

IncKdTree::Index IncKdTree::add_node(const Eigen::Vector3f& point, Index parent,
                                     std::uint8_t axis) {
  Index i = kNone;
  if (free_.empty()) {
    i = static_cast<Index>(nodes_.size());
    nodes_.emplace_back();
  } else {
    i = free_.back();
    free_.pop_back();
    at(i) = {};
  }
  Node& node = at(i);
  node.point = point;
  node.box.extend(point);
  node.parent = parent;
  node.axis = axis;
  return i;
}

// Gives the nodes back, and the points that are not deleted.
void IncKdTree::free_subtree(Index root, std::vector<Eigen::Vector3f>* alive) {
  if (root == kNone) return;
  push_down(root);
  const Node& node = at(root);
  if (!node.deleted && alive != nullptr) alive->push_back(node.point);
  free_subtree(node.left, alive);
  free_subtree(node.right, alive);
  free_.push_back(root);
}

void IncKdTree::replace_child(Index parent, Index former, Index child) {
  if (parent == kNone) {
    root_ = child;
  } else {
    Node& node = at(parent);
    (node.left == former ? node.left : node.right) = child;
  }
}

// Tells the children that all points below have been deleted.
void IncKdTree::push_down(Index i) {
  if (!at(i).all_deleted) return;
  if (at(i).left != kNone) delete_all(at(i).left);
  if (at(i).right != kNone) delete_all(at(i).right);
  at(i).all_deleted = false;
}

void IncKdTree::pull_up(Index i) {
  Node& node = at(i);
  node.size = 1;
  node.deleted_count = node.deleted ? 1 : 0;
  node.box = {};
  node.box.extend(node.point);
  for (const Index child : {node.left, node.right}) {
    if (child == kNone) continue;
    node.size += at(child).size;
    node.deleted_count += at(child).deleted_count;
    node.box.extend(at(child).box);
  }
}

void IncKdTree::pull_up_to_root(Index i) {
  for (; i != kNone; i = at(i).parent) pull_up(i);
}

void IncKdTree::delete_all(Index i) {
  Node& node = at(i);
  node.deleted = node.all_deleted = true;
  node.deleted_count = node.size;
}

bool IncKdTree::lies_below(Index i, Index root) const {
  while (i != kNone && i != root) i = at(i).parent;
  return i == root && i != kNone;
}

// ---- search ---------------------------------------------------------------------------------

void Neighbours::offer(const Eigen::Vector3f& point_m, float squared_distance_m2, int k,
                       float& limit_m2) {
  if (squared_distance_m2 > limit_m2 || k <= 0) return;
  int place = std::min(count, k - 1);
  if (count < k) ++count;
  for (; place > 0; --place) {
    const auto before = static_cast<std::size_t>(place - 1);
    if (items[before].squared_distance_m2 <= squared_distance_m2) break;
    items[before + 1] = items[before];
  }
  items[static_cast<std::size_t>(place)] = {point_m, squared_distance_m2};
  if (count == k) limit_m2 = items[static_cast<std::size_t>(k - 1)].squared_distance_m2;
}

Neighbours IncKdTree::nearest(const Eigen::Vector3f& query, int k, float max_distance_m) const {
  Neighbours found;
  float limit = max_distance_m * max_distance_m;
  if (root_ != kNone) search(root_, query, std::clamp(k, 0, kMaxNeighbours), limit, found);
  return found;
}

void IncKdTree::search(Index i, const Eigen::Vector3f& query, int k, float& limit,
                       Neighbours& found) const {
  const Node& node = at(i);
  if (node.deleted_count == node.size) return;
  // Half of the nodes are leaves, whose box is their point.
  if (node.size > 1 && node.box.squared_distance(query) > limit) return;
  if (!node.deleted) found.offer(node.point, (node.point - query).squaredNorm(), k, limit);
  // The side is judged before the child is looked at: most of the time goes into fetching nodes.
  const float beyond = query[node.axis] - node.point[node.axis];
  const Index near = beyond < 0 ? node.left : node.right;
  const Index far = beyond < 0 ? node.right : node.left;
  if (near != kNone) search(near, query, k, limit, found);
  if (far != kNone && beyond * beyond <= limit) search(far, query, k, limit, found);
}

void IncKdTree::collect(const Box& box, std::vector<Eigen::Vector3f>& out) const {
  if (root_ != kNone) collect_below(root_, box, out);
}

void IncKdTree::collect_below(Index i, const Box& box, std::vector<Eigen::Vector3f>& out) const {
  const Node& node = at(i);
  if (node.deleted_count == node.size || !box.touches(node.box)) return;
  if (!node.deleted && box.contains(node.point)) out.push_back(node.point);
  const float split = node.point[node.axis];
  if (node.left != kNone && box.min_m[node.axis] <= split) collect_below(node.left, box, out);
  if (node.right != kNone && box.max_m[node.axis] >= split) collect_below(node.right, box, out);
}

std::size_t IncKdTree::size() const {
  return root_ == kNone ? 0 : static_cast<std::size_t>(at(root_).size - at(root_).deleted_count);
}

std::size_t IncKdTree::node_count() const {
  return root_ == kNone ? 0 : static_cast<std::size_t>(at(root_).size);
}

int IncKdTree::depth() const { return depth_below(root_); }

int IncKdTree::depth_below(Index i) const {
  return i == kNone ? 0 : 1 + std::max(depth_below(at(i).left), depth_below(at(i).right));
}

}  // namespace glint::slam
