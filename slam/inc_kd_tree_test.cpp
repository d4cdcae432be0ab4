// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/inc_kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace glint::slam {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// What the tree should hold, kept the plain way.
class BruteForce {
 public:
  BruteForce(float voxel_m, float margin_m) : voxel_m_(voxel_m), margin_m_(margin_m) {}

  void insert(const Eigen::Vector3f& p) { points_.push_back(p); }
  bool insert_downsampled(const Eigen::Vector3f& p) {
    const auto cube = [&](const Eigen::Vector3f& q) -> Eigen::Vector3i {
      return (q / voxel_m_).array().floor().cast<int>();
    };
    const Eigen::Vector3i mine = cube(p);
    const Eigen::Vector3f middle =
        (mine.cast<float>() + Eigen::Vector3f::Constant(0.5F)) * voxel_m_;
    const auto off = [&](const Eigen::Vector3f& q) { return (q - middle).norm(); };
    for (const auto& q : points_) {
      if (cube(q) == mine && off(q) <= off(p) + margin_m_) return false;
    }
    std::erase_if(points_, [&](const auto& q) { return cube(q) == mine; });
    points_.push_back(p);
    return true;
  }
  void erase(const Box& box) {
    std::erase_if(points_, [&](const auto& p) { return box.contains(p); });
  }
  void keep(const Box& box) {
    std::erase_if(points_, [&](const auto& p) { return !box.contains(p); });
  }
  [[nodiscard]] std::vector<float> nearest(const Eigen::Vector3f& q, int k, float limit_m) const {
    std::vector<float> distances;
    for (const auto& p : points_) {
      const float d = (p - q).squaredNorm();
      if (d <= limit_m * limit_m) distances.push_back(d);
    }
    std::ranges::sort(distances);
    distances.resize(std::min(distances.size(), static_cast<std::size_t>(k)));
    return distances;
  }
  [[nodiscard]] const Points& points() const { return points_; }

 private:
  float voxel_m_;
  float margin_m_;
  Points points_;
};

Points sorted(Points points) {
  std::ranges::sort(points, [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  return points;
}

constexpr float kFar = 1e4F;
Box everything() {
  Box box;
  box.extend(Eigen::Vector3f::Constant(-kFar));
  box.extend(Eigen::Vector3f::Constant(kFar));
  return box;
}

/// Random work on tree and plain list, which must stay the same.
class Workload {
 public:
  explicit Workload(unsigned seed)
      : random_(seed), tree_(options()), plain_(options().voxel_m, options().margin_m) {}

  static KdTreeOptions options() {
    KdTreeOptions options;
    options.voxel_m = 0.4F;
    options.largest_inline_rebuild = 60;  // so that most rebuilds go elsewhere
    return options;
  }

  void step() {
    const int kind = whole(0, 99);
    if (kind < 60) {
      insert_some();
    } else if (kind < 70) {
      const Box box = some_box(1.5F);
      tree_.erase(box);
      plain_.erase(box);
    } else if (kind < 73) {
      const Box box = some_box(6.0F);
      tree_.keep(box);
      plain_.keep(box);
    } else if (kind < 86) {
      rebuild();
    } else {
      search();
    }
    ASSERT_EQ(tree_.size(), plain_.points().size());
  }

  void compare_points() {
    Points held;
    tree_.collect(everything(), held);
    ASSERT_EQ(sorted(held), sorted(plain_.points()));
  }

 private:
  float real(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  Eigen::Vector3f some_point() {
    // Half of them on a coarse grid, so that coordinates and borders coincide.
    Eigen::Vector3f p(real(-5, 5), real(-5, 5), real(-2, 2));
    if (whole(0, 1) == 0) p = (p * 5.0F).array().round() / 5.0F;
    return p;
  }
  Box some_box(float size) {
    Box box;
    const Eigen::Vector3f corner = some_point();
    box.extend(corner);
    box.extend(corner + Eigen::Vector3f(real(0, size), real(0, size), real(0, size)));
    return box;
  }
  void insert_some() {
    for (int i = whole(1, 40); i > 0; --i) {
      const Eigen::Vector3f p = some_point();
      if (whole(0, 3) == 0) {
        tree_.insert(p);
        plain_.insert(p);
      } else {
        ASSERT_EQ(tree_.insert_downsampled(p), plain_.insert_downsampled(p));
      }
    }
  }
  void rebuild() {
    if (under_way_) {
      under_way_->run();
      tree_.adopt(std::move(*under_way_));
      under_way_.reset();
      ++rebuilds_;
    } else {
      under_way_ = tree_.take_rebuild();
    }
  }
  void search() {
    const Eigen::Vector3f q = some_point() * 1.2F;
    const int k = whole(1, kMaxNeighbours);
    const float limit_m = real(0.1F, 4.0F);
    const Neighbours found = tree_.nearest(q, k, limit_m);
    const std::vector<float> expected = plain_.nearest(q, k, limit_m);
    ASSERT_EQ(static_cast<std::size_t>(found.count), expected.size());
    for (int i = 0; i < found.count; ++i) {
      ASSERT_EQ(found[i].squared_distance_m2, expected[static_cast<std::size_t>(i)]);
    }
  }

 public:
  int rebuilds_ = 0;

 private:
  std::mt19937 random_;
  IncKdTree tree_;
  BruteForce plain_;
  std::optional<IncKdTree::Rebuild> under_way_;
};

class RandomWork : public testing::TestWithParam<unsigned> {};

TEST_P(RandomWork, EqualsBruteForce) {
  Workload work(GetParam());
  for (int i = 0; i < 1500 && !HasFatalFailure(); ++i) {
    work.step();
    if (i % 50 == 0) work.compare_points();
  }
  EXPECT_GT(work.rebuilds_, 5);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomWork, testing::Range(1U, 9U));

int log2_of(std::size_t n) {
  return static_cast<int>(std::ceil(std::log2(static_cast<double>(n) + 1.0)));
}

TEST(IncKdTree, StaysBalancedWhenPointsComeInOrder) {
  KdTreeOptions options;
  options.largest_inline_rebuild = 1 << 20;
  IncKdTree tree(options);
  for (int i = 0; i < 20'000; ++i) tree.insert({static_cast<float>(i) * 0.01F, 0.0F, 0.0F});
  // Depth of a tree whose sides hold at most 0.6 of it.
  EXPECT_LE(tree.depth(), static_cast<int>(std::log(20'000.0) / std::log(1.0 / 0.6)) + 3);
}

TEST(IncKdTree, LargeSubtreesAreRebuiltElsewhere) {
  IncKdTree tree;
  for (int i = 0; i < 20'000; ++i) tree.insert({static_cast<float>(i) * 0.01F, 0.0F, 0.0F});
  int taken = 0;
  while (auto rebuild = tree.take_rebuild()) {
    rebuild->run();
    tree.adopt(std::move(*rebuild));
    ++taken;
  }
  EXPECT_GT(taken, 0);
  EXPECT_LE(tree.depth(), 2 * log2_of(tree.size()));
  EXPECT_EQ(tree.size(), 20'000U);
}

TEST(IncKdTree, DeletedPointsGiveTheirMemoryBack) {
  IncKdTree tree;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  std::size_t most = 0;
  // A sensor drives along: what lies behind is let go.
  for (int step = 0; step < 200; ++step) {
    const auto x = static_cast<float>(step);
    for (int i = 0; i < 300; ++i) {
      tree.insert_downsampled({x + 10.0F * unit(random), 10.0F * unit(random), unit(random)});
    }
    Box box = everything();
    box.min_m.x() = x - 20.0F;
    tree.keep(box);
    if (auto rebuild = tree.take_rebuild()) {
      rebuild->run();
      tree.adopt(std::move(*rebuild));
    }
    most = std::max(most, tree.node_count());
  }
  EXPECT_LT(most, 3 * tree.size());
}

TEST(IncKdTree, AnEmptyTreeFindsNothing) {
  IncKdTree tree;
  EXPECT_EQ(tree.nearest(Eigen::Vector3f::Zero(), 3, 10.0F).count, 0);
  tree.keep(everything());
  tree.erase(everything());
  EXPECT_EQ(tree.size(), 0U);
  EXPECT_FALSE(tree.take_rebuild());
}

TEST(IncKdTree, ARebuildFromBeforeClearIsLetGo) {
  KdTreeOptions options;
  options.largest_inline_rebuild = 20;
  IncKdTree tree(options);
  for (int i = 0; i < 200; ++i) tree.insert({static_cast<float>(i), 0.0F, 0.0F});
  auto rebuild = tree.take_rebuild();
  ASSERT_TRUE(rebuild);
  tree.clear();
  tree.insert({1.0F, 2.0F, 3.0F});
  rebuild->run();
  tree.adopt(std::move(*rebuild));
  EXPECT_EQ(tree.size(), 1U);
}

}  // namespace
}  // namespace glint::slam
