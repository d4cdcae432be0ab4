// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/box.hpp"

namespace glint::slam {

/// Most neighbours that a search may ask for.
constexpr int kMaxNeighbours = 8;

struct Neighbour {
  Eigen::Vector3f point_m;
  float squared_distance_m2 = 0.0F;
};

/// The nearest points found, nearest first. Value type, no allocation.
struct Neighbours {
  std::array<Neighbour, kMaxNeighbours> items;
  int count = 0;
  [[nodiscard]] const Neighbour& operator[](int i) const {
    return items[static_cast<std::size_t>(i)];
  }
  /// Puts a point in its place among the `k` nearest; farther ones than `limit_m2` are left out,
  /// which becomes the distance of the last of the k once there are as many.
  void offer(const Eigen::Vector3f& point_m, float squared_distance_m2, int k, float& limit_m2);
};

struct KdTreeOptions {
  /// Edge of the cubes of which each keeps one point, that nearest to its middle, m.
  float voxel_m = 0.2F;
  /// By how much nearer a point must be to take the place of what the cube holds. Beyond the noise:
  /// of points measured again and again the nearest would else be the one with the luckiest noise,
  /// and surfaces would be drawn towards the middles of their cubes.
  float margin_m = 0.05F;
  /// A subtree is rebuilt when one side has more than this share of its nodes,
  double balance = 0.6;
  /// or when more than this share of them are deleted.
  double deleted = 0.5;
  /// Larger subtrees are not rebuilt at once but handed out by take_rebuild().
  int largest_inline_rebuild = 1500;
};

/// A k-d tree that grows and shrinks with a moving sensor: points are inserted with down-sampling,
/// deleted lazily, and only unbalanced subtrees are rebuilt. After the description in [Cai, Xu &
/// Zhang 2021, "ikd-Tree: An Incremental K-D Tree for Robotic Applications"].
/// Deterministic. Thread-compatible; a Rebuild may be worked on by another thread.
class IncKdTree {
  // Of one cache line: searching is fetching nodes.
  struct alignas(64) Node {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    Box box;  // of all nodes below, deleted ones included
    std::int32_t left = -1;
    std::int32_t right = -1;
    std::int32_t parent = -1;
    std::int32_t size = 1;  // nodes of the subtree
    std::int32_t deleted_count = 0;
    std::uint8_t axis = 0;
    bool deleted = false;      // this node's point
    bool all_deleted = false;  // and those below, which have not been told yet
  };

 public:
  /// A subtree on its way to be rebuilt elsewhere, see take_rebuild().
  class Rebuild {
   public:
    /// The work: sorts the points into a balanced tree. On any thread.
    void run();

   private:
    friend class IncKdTree;
    std::vector<Eigen::Vector3f> points_;
    std::vector<Node> nodes_;
    std::uint64_t ticket_ = 0;
  };

  explicit IncKdTree(KdTreeOptions options = {}) : options_(options) {}

  /// Adds a point as it is.
  void insert(const Eigen::Vector3f& point);
  /// Adds a point unless its cube holds one that is about as near to the cube's middle; else it
  /// takes the place of what the cube holds. False if it was not added.
  bool insert_downsampled(const Eigen::Vector3f& point);
  /// Deletes the points inside a box, borders included.
  void erase(const Box& box);
  /// Deletes the points outside a box.
  void keep(const Box& box);
  void clear();

  /// The `k` nearest points (at most kMaxNeighbours) within `max_distance_m`.
  [[nodiscard]] Neighbours nearest(const Eigen::Vector3f& query, int k, float max_distance_m) const;
  /// All points inside a box, in the order of the tree.
  void collect(const Box& box, std::vector<Eigen::Vector3f>& out) const;

  [[nodiscard]] std::size_t size() const;  ///< Points.
  /// Nodes, deleted ones included.
  [[nodiscard]] std::size_t node_count() const;
  /// Longest way from the root to a leaf.
  [[nodiscard]] int depth() const;

  /// The subtree that waits to be rebuilt, if there is one and none is under way. The tree works on
  /// meanwhile; adopt() puts the result in place. What becomes of the tree depends on when these
  /// two are called, not on how long run() takes.
  [[nodiscard]] std::optional<Rebuild> take_rebuild();
  /// Takes a rebuilt subtree in, with what was inserted and deleted since. One that clear() has
  /// made void is let go.
  void adopt(Rebuild&& rebuild);

 private:
  using Index = std::int32_t;
  static constexpr Index kNone = -1;
  /// What happened to a subtree while it was being rebuilt.
  struct LogEntry {
    enum class Kind { kInsert, kErasePoint, kErase, kKeep } kind = Kind::kInsert;
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    Box box;
  };

  [[nodiscard]] Node& at(Index i) { return nodes_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Node& at(Index i) const { return nodes_[static_cast<std::size_t>(i)]; }

  Index add_node(const Eigen::Vector3f& point, Index parent, std::uint8_t axis);
  void free_subtree(Index root, std::vector<Eigen::Vector3f>* alive);
  void replace_child(Index parent, Index former, Index child);
  void push_down(Index i);
  void pull_up(Index i);
  void pull_up_to_root(Index i);
  void delete_all(Index i);

  Index insert_below(Index root, const Eigen::Vector3f& point);
  bool erase_point_below(Index root, const Eigen::Vector3f& point);
  void erase_below(Index root, const Box& box);
  void keep_below(Index root, const Box& box);
  void search(Index i, const Eigen::Vector3f& query, int k, float& limit, Neighbours& found) const;
  void collect_below(Index i, const Box& box, std::vector<Eigen::Vector3f>& out) const;
  [[nodiscard]] int depth_below(Index i) const;

  [[nodiscard]] bool unbalanced(const Node& node) const;
  void mend_above(Index leaf);
  void mend_below(Index root);
  bool rebuild_here(Index root);
  Index graft(const std::vector<Node>& nodes, Index parent);
  [[nodiscard]] bool lies_below(Index i, Index root) const;
  [[nodiscard]] Index find_large_unbalanced(Index root) const;
  void log(LogEntry entry);
  Index replay(Index root, const LogEntry& entry);

  static Index build(std::vector<Eigen::Vector3f>& points, std::size_t begin, std::size_t end,
                     Index parent, std::vector<Node>& nodes);

  KdTreeOptions options_;
  std::vector<Node> nodes_;
  std::vector<Index> free_;
  Index root_ = kNone;

  Index being_rebuilt_ = kNone;
  std::uint64_t ticket_ = 0;  // of the latest rebuild; clear() makes earlier ones void
  std::vector<LogEntry> log_;

  // Reused.
  std::vector<Eigen::Vector3f> points_;
  std::vector<Eigen::Vector3f> in_cube_;
  std::vector<Node> built_;
  std::vector<Index> grafted_;
};

}  // namespace glint::slam
