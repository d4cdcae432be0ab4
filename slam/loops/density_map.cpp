// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/density_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace glint::slam {
namespace {

// Heights above the floor that count, as bits of a word.
constexpr int kLevels = 32;
// A cell as full as this is white.
constexpr int kFull = 8;
// Cells to the farthest points on either side, about; what lies farther out is left out.
constexpr int kReach_px = 160;
// Of the points' distances, the one that the map should reach.
constexpr double kReachQuantile = 0.9;
constexpr float kFloorStep_m = 0.1F;
constexpr int kFloorSteps = 200;
constexpr double kFloorShare = 0.25;
// ORB's patch.
constexpr int kDensityPatch_px = 31;
constexpr int kFastThreshold = 12;

// Half the image's side: doubled steps of the cell, so that a place gets the same one again.
float choose_cell_m(const std::vector<Eigen::Vector3f>& points_m, const DensityOptions& options) {
  std::vector<float> distances_m;
  distances_m.reserve(points_m.size());
  for (const auto& p : points_m) distances_m.push_back(p.head<2>().norm());
  const auto nth =
      distances_m.begin() +
      static_cast<std::ptrdiff_t>(kReachQuantile * static_cast<double>(distances_m.size()));
  std::nth_element(distances_m.begin(), nth, distances_m.end());
  float cell_m = options.finest_cell_m;
  while (cell_m < options.coarsest_cell_m && cell_m * static_cast<float>(kReach_px) < *nth) {
    cell_m *= 2.0F;
  }
  return cell_m;
}

// The lowest height at which much lies.
float find_floor(const std::vector<Eigen::Vector3f>& points_m) {
  std::vector<int> counts(kFloorSteps, 0);
  for (const auto& p : points_m) {
    const int step = static_cast<int>(std::floor(p.z() / kFloorStep_m)) + kFloorSteps / 2;
    if (step >= 0 && step < kFloorSteps) ++counts[static_cast<std::size_t>(step)];
  }
  const int most = *std::ranges::max_element(counts);
  const auto lowest = std::ranges::find_if(counts, [&](int n) { return n >= kFloorShare * most; });
  return (static_cast<float>(lowest - counts.begin()) + 0.5F - 0.5F * kFloorSteps) * kFloorStep_m;
}

}  // namespace

DensityImage make_density_image(const Place& base, std::span<const Place> around,
                                const DensityOptions& options) {
  const std::vector<Eigen::Vector3f> points_m =
      points_of(around, {Eigen::Quaterniond::Identity(), -base.T_odom_sensor.translation_m});
  DensityImage image;
  if (points_m.empty()) return image;
  image.cell_m = choose_cell_m(points_m, options);
  image.floor_m = find_floor(points_m);
  const int side_px = 2 * (kReach_px + kDensityPatch_px);
  image.corner_m.setConstant(-0.5F * static_cast<float>(side_px) * image.cell_m);
  const float level_m = image.cell_m;
  cv::Mat1i levels(side_px, side_px, 0);
  for (const auto& p : points_m) {
    const int u = static_cast<int>(std::floor((p.x() - image.corner_m.x()) / image.cell_m));
    const int v = static_cast<int>(std::floor((p.y() - image.corner_m.y()) / image.cell_m));
    const int w = static_cast<int>(std::floor((p.z() - image.floor_m) / level_m));
    if (u < 0 || v < 0 || u >= side_px || v >= side_px || w < 1 || w >= kLevels) continue;
    levels(v, u) |= static_cast<int>(1U << static_cast<unsigned>(w));
  }
  image.grey.create(side_px, side_px);
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      const int count = std::popcount(static_cast<unsigned>(levels(v, u)));
      image.grey(v, u) = static_cast<std::uint8_t>(255 * std::min(count, kFull) / kFull);
    }
  }
  return image;
}

DensityMap make_density_map(const Place& base, std::span<const Place> around,
                            const DensityOptions& options) {
  const DensityImage image = make_density_image(base, around, options);
  DensityMap map;
  map.cell_m = image.cell_m;
  map.floor_m = image.floor_m;
  if (image.grey.empty()) return map;
  cv::Mat smooth;
  cv::GaussianBlur(image.grey, smooth, {5, 5}, 1.0);
  const auto orb = cv::ORB::create(options.most_corners, 1.2F, 1, kDensityPatch_px, 0, 2,
                                   cv::ORB::HARRIS_SCORE, kDensityPatch_px, kFastThreshold);
  std::vector<cv::KeyPoint> corners;
  cv::Mat descriptors;
  orb->detectAndCompute(smooth, cv::noArray(), corners, descriptors);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Descriptor descriptor;
    std::memcpy(descriptor.data(), descriptors.ptr(static_cast<int>(i)), sizeof descriptor);
    map.descriptors.push_back(descriptor);
    map.at_m.emplace_back(image.corner_m.x() + (corners[i].pt.x + 0.5F) * image.cell_m,
                          image.corner_m.y() + (corners[i].pt.y + 0.5F) * image.cell_m);
    map.angle_rad.push_back(corners[i].angle * static_cast<float>(M_PI / 180.0));
  }
  return map;
}

}  // namespace glint::slam
