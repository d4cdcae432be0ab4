// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The odometry's map of surfaces, kept three ways: the incremental k-d tree, nanoflann's dynamic
// index, and a hash of voxels. The work is a scan's: its points are looked up (six nearest within a
// metre), then added, one being kept in each voxel, while the sensor moves through a street canyon.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numbers>
#include <random>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "slam/inc_kd_tree.hpp"

namespace glint::slam {
namespace {

constexpr int kScans = 300;
constexpr int kPoints = 1200;
constexpr int kNearest = 6;
constexpr float kReach_m = 1.0F;
constexpr float kVoxel_m = 0.4F;

using Scan = std::vector<Eigen::Vector3f>;

// Rays from a sensor that walks along x: to the ground, to houses of different depth, to the sky.
std::vector<Scan> street_scans() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  std::vector<Scan> scans(kScans);
  for (int k = 0; k < kScans; ++k) {
    const Eigen::Vector3f sensor(0.3F * static_cast<float>(k), 0.0F, 1.5F);
    Scan& scan = scans[static_cast<std::size_t>(k)];
    while (scan.size() < kPoints) {
      const float azimuth = 2.0F * std::numbers::pi_v<float> * unit(random);
      const float elevation = 0.8F * (unit(random) - 0.5F);
      const Eigen::Vector3f ray(std::cos(azimuth) * std::cos(elevation),
                                std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      const float block = std::floor((sensor.x() + 8.0F * ray.x()) / 12.0F);
      const float wall_m = 6.0F + 2.0F * std::abs(std::sin(7.0F * block));
      const float to_wall = wall_m / std::max(std::abs(ray.y()), 1e-3F);
      const float to_ground = ray.z() < 0 ? sensor.z() / -ray.z() : 1e3F;
      const float range_m = std::min(to_wall, to_ground);
      if (range_m > 60.0F) continue;
      scan.push_back(sensor + (range_m + noise(random)) * ray);
    }
  }
  return scans;
}

Eigen::Vector3i voxel_of(const Eigen::Vector3f& point) {
  return (point / kVoxel_m).array().floor().cast<int>();
}

struct VoxelHash {
  std::size_t operator()(const Eigen::Vector3i& v) const {
    return static_cast<std::size_t>(v.x()) * 73'856'093U ^
           static_cast<std::size_t>(v.y()) * 19'349'669U ^
           static_cast<std::size_t>(v.z()) * 83'492'791U;
  }
};

class TreeMap {
 public:
  void add(const Scan& scan) {
    for (const Eigen::Vector3f& point : scan) tree_.insert_downsampled(point);
    // As the odometry has it: a large subtree a scan.
    if (auto rebuild = tree_.take_rebuild()) {
      rebuild->run();
      tree_.adopt(std::move(*rebuild));
    }
  }
  [[nodiscard]] int near(const Eigen::Vector3f& point) const {
    return tree_.nearest(point, kNearest, kReach_m).count;
  }

 private:
  static KdTreeOptions options() {
    KdTreeOptions options;
    options.voxel_m = kVoxel_m;
    return options;
  }
  IncKdTree tree_{options()};
};

/// What nanoflann does not do itself, to keep one point a voxel, is done before it.
class NanoflannMap {
 public:
  void add(const Scan& scan) {
    const std::size_t before = cloud_.points.size();
    for (const Eigen::Vector3f& point : scan) {
      if (taken_.insert(voxel_of(point)).second) cloud_.points.push_back(point);
    }
    if (cloud_.points.size() > before) {
      index_.addPoints(static_cast<unsigned>(before),
                       static_cast<unsigned>(cloud_.points.size() - 1));
    }
  }
  [[nodiscard]] int near(const Eigen::Vector3f& point) const {
    std::array<std::size_t, kNearest> indices{};
    std::array<float, kNearest> distances{};
    nanoflann::KNNResultSet<float> result(kNearest);
    result.init(indices.data(), distances.data());
    index_.findNeighbors(result, point.data(), nanoflann::SearchParams());
    return static_cast<int>(std::count_if(distances.begin(),
                                          distances.begin() + static_cast<int>(result.size()),
                                          [](float d) { return d <= kReach_m * kReach_m; }));
  }

 private:
  struct Cloud {
    Scan points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return points[i][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };
  using Index =
      nanoflann::KDTreeSingleIndexDynamicAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud,
                                                 3>;
  Cloud cloud_;
  std::unordered_set<Eigen::Vector3i, VoxelHash> taken_;
  Index index_{3, cloud_};
};

/// All voxels within reach are looked at, so that the answer is the same.
class HashMap {
 public:
  void add(const Scan& scan) {
    for (const Eigen::Vector3f& point : scan) voxels_.try_emplace(voxel_of(point), point);
  }
  [[nodiscard]] int near(const Eigen::Vector3f& point) const {
    Neighbours found;
    float limit = kReach_m * kReach_m;
    const Eigen::Vector3i low = voxel_of(point - Eigen::Vector3f::Constant(kReach_m));
    const Eigen::Vector3i high = voxel_of(point + Eigen::Vector3f::Constant(kReach_m));
    for (int x = low.x(); x <= high.x(); ++x) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int z = low.z(); z <= high.z(); ++z) {
          const auto voxel = voxels_.find({x, y, z});
          if (voxel == voxels_.end()) continue;
          found.offer(voxel->second, (voxel->second - point).squaredNorm(), kNearest, limit);
        }
      }
    }
    return found.count;
  }

 private:
  std::unordered_map<Eigen::Vector3i, Eigen::Vector3f, VoxelHash> voxels_;
};

template <class Map>
void walk(benchmark::State& state) {
  const std::vector<Scan> scans = street_scans();
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    Map map;
    int found = 0;
    for (const Scan& scan : scans) {
      for (const Eigen::Vector3f& point : scan) found += map.near(point);
      map.add(scan);
    }
    state.counters["found"] = found;
  }
  state.counters["s_per_scan"] =
      benchmark::Counter(static_cast<double>(state.iterations() * kScans),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK(walk<TreeMap>)->Unit(benchmark::kMillisecond);
BENCHMARK(walk<NanoflannMap>)->Unit(benchmark::kMillisecond);
BENCHMARK(walk<HashMap>)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glint::slam

BENCHMARK_MAIN();
