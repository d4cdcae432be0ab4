// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/voxel_plane_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

#include "slam/loops/voxel_key.hpp"

namespace glint::slam {
namespace {

// Edges of the voxels; beams are too far apart for the smaller ones beyond these ranges.
constexpr std::array<float, 3> kVoxelEdge_m = {1.0F, 0.5F, 0.25F};
constexpr std::array<float, 3> kFarthestForVoxel_m = {1e6F, 40.0F, 15.0F};
// A surface at a voxel's face belongs to both sides, or its noise would be cut in two.
constexpr float kVoxelMargin_m = 0.05F;
// What a plane term of weight 1 is good to.
constexpr float kUnitVoxel_m2 = 0.02F * 0.02F;
// Shorter ways are jitter: who stands goes nowhere.
constexpr double kLeastStep_m = 0.3;
// Older points fade once there are so many.
constexpr float kMostInVoxel = 400.0F;
constexpr float kFewestInVoxel = 6.0F;
// A plane that few points fix is off by more than they show: as if it had been fixed by so many
// less.
constexpr float kSpentPoints = 5.0F;
// A plane is fitted anew with so many times the points.
constexpr float kRefit = 1.3F;
constexpr float kUsualPoints = 6.0F;
// Points that lie farther off their plane lie on more than one.
constexpr float kRoughest_m2 = 0.06F * 0.06F;
// Across and along: points in line fit any plane around them.
constexpr float kLeastWidth = 9.0F;
constexpr float kLeastVoxelSpread = 0.02F;

std::uint64_t key_of(const Eigen::Vector3i& voxel, std::size_t level, bool ground) {
  // 20 bits an axis; no key is zero.
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 20U) - 1U;
  std::uint64_t key = 1U | (ground ? 2U : 0U) | static_cast<std::uint64_t>(level) << 2U;
  for (int axis = 0; axis < 3; ++axis) {
    key |= (static_cast<std::uint64_t>(voxel[axis]) & kMask)
           << (4U + 20U * static_cast<unsigned>(axis));
  }
  return key;
}

std::uint64_t mixed(std::uint64_t key) {
  key *= 0x9E3779B97F4A7C15ULL;
  key ^= key >> 32U;
  key *= 0xD6E8FEB86659FD93ULL;
  return key ^ key >> 32U;
}

}  // namespace

void VoxelPlaneMap::Voxel::begin(const Eigen::Vector3f& point_m) {
  *this = Voxel{};
  origin_m = point_m;
}

void VoxelPlaneMap::Voxel::take(const Eigen::Vector3f& point_m) {
  if (points >= kMostInVoxel) {
    constexpr float kFade = 0.5F;
    points *= kFade;
    fitted_at *= kFade;
    sum_m *= kFade;
    for (float& square_m2 : squares_m2) square_m2 *= kFade;
  }
  const Eigen::Vector3f d = point_m - origin_m;
  points += 1.0F;
  sum_m += d;
  squares_m2[0] += d.x() * d.x();
  squares_m2[1] += d.x() * d.y();
  squares_m2[2] += d.x() * d.z();
  squares_m2[3] += d.y() * d.y();
  squares_m2[4] += d.y() * d.z();
  squares_m2[5] += d.z() * d.z();
  if (points >= kFewestInVoxel && points >= kRefit * fitted_at) fit();
}

void VoxelPlaneMap::Voxel::fit() {
  fitted_at = points;
  const Eigen::Vector3f mean = sum_m / points;
  Eigen::Matrix3f covariance;
  covariance << squares_m2[0], squares_m2[1], squares_m2[2],  //
      squares_m2[1], squares_m2[3], squares_m2[4],            //
      squares_m2[2], squares_m2[4], squares_m2[5];
  covariance = covariance / points - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(covariance);
  const Eigen::Vector3f& variances_m2 = eigen.eigenvalues();
  // Three of the points' freedoms went into the plane. Few points may lie on one by chance: what is
  // usual counts like some more.
  roughness_m2 = (std::max(variances_m2(0), 0.0F) * points + kUsualPoints * kUnitVoxel_m2) /
                 (points - 3.0F + kUsualPoints);
  width_m2 = variances_m2(1);
  flat = roughness_m2 < kRoughest_m2 && width_m2 > kLeastWidth * roughness_m2 &&
         width_m2 > kLeastVoxelSpread * variances_m2(2);
  normal = eigen.eigenvectors().col(0).normalized();
  mean_m = origin_m + mean;
}

float VoxelPlaneMap::Voxel::variance_m2(const Eigen::Vector3f& place_m) const {
  const float along_m2 = (place_m - mean_m).squaredNorm();
  return roughness_m2 * (1.0F + (1.0F + along_m2 / width_m2) / (points - kSpentPoints));
}

VoxelPlaneMap::VoxelPlaneMap(const VoxelPlaneOptions& options)
    : options_(options),
      buckets_(std::bit_floor(std::max<std::size_t>(options.bytes / sizeof(Bucket), 1))) {
  clear();
}

void VoxelPlaneMap::clear() {
  for (Bucket& bucket : buckets_) bucket.keys.fill(0);
  voxels_ = 0;
  way_m_ = 0.0;
  last_place_m_.reset();
}

const VoxelPlaneMap::Voxel* VoxelPlaneMap::find(std::uint64_t key) const {
  const Bucket& bucket = buckets_[mixed(key) & (buckets_.size() - 1)];
  for (std::size_t i = 0; i < kWays; ++i) {
    if (bucket.keys[i] == key) return &bucket.voxels[i];
  }
  return nullptr;
}

VoxelPlaneMap::Voxel& VoxelPlaneMap::find_or_begin(std::uint64_t key,
                                                   const Eigen::Vector3f& place_m) {
  Bucket& bucket = buckets_[mixed(key) & (buckets_.size() - 1)];
  std::size_t oldest = 0;
  for (std::size_t i = 0; i < kWays; ++i) {
    if (bucket.keys[i] == key) {
      if (!is_current(bucket.voxels[i])) bucket.voxels[i].begin(place_m);
      return bucket.voxels[i];
    }
    if (bucket.keys[oldest] == 0) continue;
    if (bucket.keys[i] == 0 || bucket.voxels[i].seen_way_m < bucket.voxels[oldest].seen_way_m) {
      oldest = i;
    }
  }
  if (bucket.keys[oldest] == 0) ++voxels_;
  bucket.keys[oldest] = key;
  bucket.voxels[oldest].begin(place_m);
  return bucket.voxels[oldest];
}

bool VoxelPlaneMap::is_current(const Voxel& voxel) const {
  return options_.reach_m <= 0.0 || way_m_ - voxel.seen_way_m < options_.reach_m;
}

const VoxelPlaneMap::Voxel* VoxelPlaneMap::plane_at(const Eigen::Vector3f& place_m,
                                                    bool ground) const {
  const auto fitted = [&](std::size_t level) -> const Voxel* {
    const Voxel* voxel = find(key_of(voxel_of(place_m, kVoxelEdge_m[level]), level, ground));
    return voxel != nullptr && is_current(*voxel) && voxel->fitted_at > 0.0F ? voxel : nullptr;
  };
  const Voxel* voxel = fitted(1);
  if (voxel == nullptr) {
    voxel = fitted(0);
  } else if (!voxel->flat) {
    voxel = fitted(2);
  }
  return voxel != nullptr && voxel->flat ? voxel : nullptr;
}

void VoxelPlaneMap::associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                              const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) {
  terms.clear();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d point_m = points_m[i].cast<double>();
    const Eigen::Vector3f place_m = (T_odom_scan * point_m).cast<float>();
    const bool ground = i < ground_count;
    const Voxel* plane = plane_at(place_m, ground);
    if (plane == nullptr) continue;
    const float distance_m = plane->normal.dot(place_m - plane->mean_m);
    if (std::abs(distance_m) > static_cast<float>(options_.largest_residual_m)) continue;
    PlaneTerm term;
    term.point_m = point_m;
    term.normal = plane->normal.cast<double>();
    term.offset_m = term.normal.dot(plane->mean_m.cast<double>());
    const float variance_m2 = plane->variance_m2(place_m);
    term.weight = kUnitVoxel_m2 / std::max(variance_m2, kUnitVoxel_m2) *
                  (ground ? options_.ground_weight : 1.0);
    terms.push_back(term);
  }
}

void VoxelPlaneMap::associate_again(std::span<const Eigen::Vector3f> points_m,
                                    std::size_t ground_count, const Pose& T_odom_scan,
                                    std::vector<PlaneTerm>& terms) {
  associate(points_m, ground_count, T_odom_scan, terms);
}

void VoxelPlaneMap::add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                        const Pose& T_odom_scan) {
  const Eigen::Vector3d& here_m = T_odom_scan.translation_m;
  if (!last_place_m_) last_place_m_ = here_m;
  const double step_m = (here_m - *last_place_m_).norm();
  if (step_m > kLeastStep_m) {
    way_m_ += step_m;
    last_place_m_ = here_m;
  }
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3f place_m = (T_odom_scan * points_m[i].cast<double>()).cast<float>();
    add_point(place_m, points_m[i].norm(), i < ground_count);
  }
}

void VoxelPlaneMap::add_point(const Eigen::Vector3f& place_m, float range_m, bool ground) {
  const Eigen::Vector3f margin_m = Eigen::Vector3f::Constant(kVoxelMargin_m);
  for (std::size_t level = 0; level < kVoxelEdge_m.size(); ++level) {
    if (range_m > kFarthestForVoxel_m[level]) break;
    const Eigen::Vector3i low = voxel_of(place_m - margin_m, kVoxelEdge_m[level]);
    const Eigen::Vector3i high = voxel_of(place_m + margin_m, kVoxelEdge_m[level]);
    for (int x = low.x(); x <= high.x(); ++x) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int z = low.z(); z <= high.z(); ++z) {
          Voxel& voxel = find_or_begin(key_of({x, y, z}, level, ground), place_m);
          voxel.seen_way_m = way_m_;
          voxel.take(place_m);
        }
      }
    }
  }
}

}  // namespace glint::slam
