// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/plane_features.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glint::slam {
namespace {

// Neighbours to either side that LOAM's curvature looks at.
constexpr int kSide = 5;
// Every so many-th point of a ring may be taken: neighbours say the same.
constexpr int kStep = 2;
// Places in the table of voxels for each point wanted.
constexpr std::size_t kTableShare = 8;

// A voxel's coordinates in one word, never 0.
std::uint64_t voxel_key(const Eigen::Vector3f& point, float edge_m) {
  constexpr std::uint64_t kMask = (1U << 20U) - 1U;
  std::uint64_t key = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(point[axis] / edge_m));
    key = (key << 20U) | (static_cast<std::uint64_t>(cell) & kMask);
  }
  return key;
}

}  // namespace

PlaneExtractor::PlaneExtractor(const SensorInfo& info, PlaneFeatureOptions options,
                               std::shared_ptr<const XyzLut> lut)
    : options_(options), lut_(std::move(lut)), shift_(info.pixel_shift_by_row) {
  const auto columns = static_cast<std::size_t>(info.columns_per_frame);
  rotation_.resize(columns);
  translation_m_.resize(columns);
  ring_.resize(columns);
  valid_.resize(columns);
  const std::size_t pixels = columns * static_cast<std::size_t>(info.pixels_per_column);
  flat_.reserve(pixels / kStep);
  // Small enough to stay in the cache, and far from full with the number of points wanted.
  std::size_t size = 1;
  while (size < kTableShare * static_cast<std::size_t>(options_.wanted_points)) size *= 2;
  voxel_table_.resize(size);
}

const std::vector<Eigen::Vector3f>& PlaneExtractor::extract(
    const ScanImages& images, std::span<const Pose> T_reference_column) {
  place_columns(T_reference_column);
  flat_.clear();
  for (int row = 0; row < images.range_mm.rows; ++row) {
    fill_ring(images, row);
    take_flat_points();
  }
  thin_out();
  return kept_;
}

void PlaneExtractor::place_columns(std::span<const Pose> T_reference_column) {
  rigid_ = T_reference_column.empty();
  for (std::size_t m = 0; m < T_reference_column.size(); ++m) {
    rotation_[m] = T_reference_column[m].rotation.toRotationMatrix().cast<float>();
    translation_m_[m] = T_reference_column[m].translation_m.cast<float>();
  }
}

// A ring begins and ends at the scan's seam, over which no neighbours are looked for: its two sides
// were measured a whole turn apart.
void PlaneExtractor::fill_ring(const ScanImages& images, int row) {
  const int columns = images.range_mm.cols;
  const int shift = shift_[static_cast<std::size_t>(row)];
  int u = (shift % columns + columns) % columns;
  for (int m = 0; m < columns; ++m, u = u + 1 == columns ? 0 : u + 1) {
    const auto i = static_cast<std::size_t>(m);
    const std::uint32_t range_mm = images.range_mm(row, u);
    valid_[i] = range_mm != 0 ? 1 : 0;
    const Eigen::Vector3f point = lut_->point(row, m, range_mm).cast<float>();
    ring_[i] = rigid_ ? point : Eigen::Vector3f(rotation_[i] * point + translation_m_[i]);
  }
}

void PlaneExtractor::take_flat_points() {
  const auto largest = static_cast<float>(options_.largest_curvature_m2);
  constexpr std::size_t kWindow = 2 * kSide + 1;
  if (ring_.size() < kWindow) return;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  std::size_t returns = 0;
  for (std::size_t end = 0; end < ring_.size(); ++end) {
    sum += ring_[end];
    returns += valid_[end];
    if (end >= kWindow) {
      sum -= ring_[end - kWindow];
      returns -= valid_[end - kWindow];
    }
    if (returns != kWindow || (end - kSide) % kStep != 0) continue;
    const Eigen::Vector3f& middle = ring_[end - kSide];
    const float curvature = (sum - static_cast<float>(kWindow) * middle).squaredNorm();
    if (curvature < largest) flat_.push_back(middle);
  }
}

// Keeps the first point of each voxel; the voxels follow the number wanted.
void PlaneExtractor::thin_out() {
  std::fill(voxel_table_.begin(), voxel_table_.end(), 0U);
  kept_.clear();
  const std::size_t mask = voxel_table_.size() - 1;
  // All of them once, each far from the last.
  std::size_t step = options_.in_order ? 1 : flat_.size() * 5 / 8;
  while (std::gcd(step, flat_.size()) > 1) ++step;
  std::size_t next = 0;
  for (std::size_t i = 0; i < flat_.size(); ++i) {
    const Eigen::Vector3f& point = flat_[next];
    next = (next + step) % flat_.size();
    const std::uint64_t key = voxel_key(point, static_cast<float>(voxel_m_));
    std::size_t slot = (key * 0x9E37'79B9'7F4A'7C15ULL) >> 20U & mask;
    while (voxel_table_[slot] != 0 && voxel_table_[slot] != key) slot = (slot + 1) & mask;
    if (voxel_table_[slot] == key) continue;
    voxel_table_[slot] = key;
    kept_.push_back(point);
    // Far more than wanted: the voxels are too small yet.
    if (kept_.size() > voxel_table_.size() / 2) break;
  }
  // On surfaces the number goes with the square of the edge.
  const double share =
      static_cast<double>(std::max<std::size_t>(1, kept_.size())) / options_.wanted_points;
  voxel_m_ = std::clamp(voxel_m_ * std::clamp(std::sqrt(share), 0.7, 1.4),
                        options_.smallest_voxel_m, options_.largest_voxel_m);
}

}  // namespace glint::slam
