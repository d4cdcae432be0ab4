// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/plane_map.hpp"

namespace glint::slam {

struct VoxelPlaneOptions {
  std::size_t bytes = 48'000'000;  ///< Of memory; the surfaces seen longest ago make room.
  double largest_residual_m = 0.5;
  double ground_weight = 2.0;
  /// Surfaces last seen this much of the sensor's way ago do not count any more; 0: all do.
  double reach_m = 50.0;
};

/// Planes in hashed voxels of three sizes, each fitted to all points that ever fell there, so that
/// their noise averages out [after Yuan et al. 2022, "Efficient and Probabilistic Adaptive Voxel
/// Mapping"]. A point's plane is that of the middle-sized voxel, of a smaller one where things are
/// finer, of a larger one where little was seen so far. What a plane is good to - the roughness of
/// its points, and how well these fix it there - is its term's weight. Where odometry comes back
/// after a round, the surfaces of then lie beside those of now, by its drift; so voxels that were
/// left behind begin anew. Memory is bounded, and so is the time of each point.
class VoxelPlaneMap final : public PlaneMap {
 public:
  explicit VoxelPlaneMap(const VoxelPlaneOptions& options);

  void associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                 const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) override;
  void associate_again(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                       const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) override;
  void add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
           const Pose& T_odom_scan) override;
  void clear() override;
  /// Voxels with points.
  [[nodiscard]] std::size_t size() const override { return voxels_; }

 private:
  /// Points about their mean, and their plane as of `fitted_at` points.
  struct Voxel {
    double seen_way_m = 0.0;  ///< Of the sensor's way, when a point came last.
    float points = 0.0F;
    float fitted_at = 0.0F;
    float roughness_m2 = 0.0F;
    float width_m2 = 0.0F;  ///< Variance of the points along the plane's narrower axis.
    bool flat = false;
    Eigen::Vector3f origin_m = Eigen::Vector3f::Zero();  ///< The sums are relative to it.
    Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
    std::array<float, 6> squares_m2 = {};  ///< xx xy xz yy yz zz
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();

    void begin(const Eigen::Vector3f& point_m);
    void take(const Eigen::Vector3f& point_m);
    void fit();
    /// Variance of a point's distance from the plane there, m^2.
    [[nodiscard]] float variance_m2(const Eigen::Vector3f& place_m) const;
  };
  static constexpr std::size_t kWays = 8;
  /// Voxels whose keys have one hash: who comes to a full one takes the place of the longest
  /// unseen.
  struct Bucket {
    std::array<std::uint64_t, kWays> keys;  // 0: free
    std::array<Voxel, kWays> voxels;
  };

  [[nodiscard]] const Voxel* find(std::uint64_t key) const;
  Voxel& find_or_begin(std::uint64_t key, const Eigen::Vector3f& place_m);
  [[nodiscard]] const Voxel* plane_at(const Eigen::Vector3f& place_m, bool ground) const;
  void add_point(const Eigen::Vector3f& place_m, float range_m, bool ground);
  [[nodiscard]] bool is_current(const Voxel& voxel) const;

  VoxelPlaneOptions options_;
  std::vector<Bucket> buckets_;  // a power of two
  std::size_t voxels_ = 0;
  double way_m_ = 0.0;
  std::optional<Eigen::Vector3d> last_place_m_;
};

}  // namespace glint::slam
