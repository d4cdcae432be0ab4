// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/ground.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace glint::slam {
namespace {

// Where nothing is known of the height, the ground lies at least so far below the sensor.
constexpr double kLeastHeight_m = 0.15;
// How fast the height follows what is found, per scan.
constexpr double kHeightGain = 0.1;
// The ground need not be level: with the distance it may rise and fall by so much.
constexpr double kSlope = 0.1;
// A slice so many inlier distances above the ground has far fewer points.
constexpr double kSliceAbove = 3.0;
constexpr int kLeastContrast = 3;
// Without ground for so long, 1.5 to 3 s, the height it was found at is not believed any more: it
// may have been that of a table.
constexpr int kPatience_scans = 30;

void keep_every(std::size_t step, std::vector<Eigen::Vector3d>& points) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); i += step) points[kept++] = points[i];
  points.resize(kept);
}

double distance(const GroundPlane& plane, const Eigen::Vector3d& point) {
  return plane.normal.dot(point) + plane.height_m;
}

}  // namespace

std::optional<GroundPlane> GroundFinder::find(std::span<Eigen::Vector3f> points_m,
                                              const Eigen::Vector3d& up,
                                              std::size_t* ground_count) {
  *ground_count = 0;
  if (!height_m_ && options_.sensor_height_m > 0) height_m_ = options_.sensor_height_m;
  std::optional<GroundPlane> plane = find_plane(points_m, up);
  if (!plane) {
    if (++missed_scans_ >= kPatience_scans) reset();
    return std::nullopt;
  }
  missed_scans_ = 0;
  height_m_ =
      height_m_ ? *height_m_ + kHeightGain * (plane->height_m - *height_m_) : plane->height_m;
  // Not std::ranges', which clang-14 cannot read in g++ 12's library.
  const auto others =
      std::stable_partition(points_m.begin(), points_m.end(), [&](const Eigen::Vector3f& p) {
        return std::abs(distance(*plane, p.cast<double>())) < options_.inlier_m;
      });
  *ground_count = static_cast<std::size_t>(others - points_m.begin());
  return plane;
}

std::optional<GroundPlane> GroundFinder::find_plane(std::span<const Eigen::Vector3f> points_m,
                                                    const Eigen::Vector3d& up) {
  collect_candidates(points_m, up);
  std::optional<GroundPlane> plane = sample_planes(up);
  if (plane) plane = refine(*plane);
  return plane && plausible(*plane, up) ? plane : std::nullopt;
}

bool GroundFinder::plausible(const GroundPlane& plane, const Eigen::Vector3d& up) const {
  if (plane.normal.dot(up) < std::cos(options_.largest_tilt_rad)) return false;
  return !height_m_ || std::abs(plane.height_m - *height_m_) < options_.height_band_m;
}

void GroundFinder::collect_candidates(std::span<const Eigen::Vector3f> points_m,
                                      const Eigen::Vector3d& up) {
  candidates_.clear();
  above_.clear();
  // The slice that planes are to stand out against may reach so far above the highest of them.
  const double slice_m = (kSliceAbove + 1.0) * options_.inlier_m;
  for (const Eigen::Vector3f& p : points_m) {
    const Eigen::Vector3d point = p.cast<double>();
    const double z_m = up.dot(point);
    const double slope_m = kSlope * (point - z_m * up).norm();
    const double reach_m = options_.height_band_m + slope_m;
    const double highest_m = height_m_ ? reach_m - *height_m_ : -kLeastHeight_m;
    const bool fits = z_m < highest_m && (!height_m_ || z_m > -*height_m_ - reach_m);
    if (fits) {
      candidates_.push_back(point);
    } else if (z_m >= highest_m && z_m < highest_m + slice_m) {
      above_.push_back(point);
    }
  }
  const auto most = static_cast<std::size_t>(options_.largest_sample);
  if (candidates_.size() <= most) return;
  const std::size_t step = (candidates_.size() + most - 1) / most;
  keep_every(step, candidates_);
  keep_every(step, above_);
}

// The plane through three candidates that holds most of them.
std::optional<GroundPlane> GroundFinder::sample_planes(const Eigen::Vector3d& up) {
  const auto size = static_cast<std::uint32_t>(candidates_.size());
  if (static_cast<int>(size) < options_.fewest_inliers) return std::nullopt;
  std::mt19937 random(4711);  // The same samples each time: results repeat bit for bit.
  std::optional<GroundPlane> best;
  for (int i = 0; i < options_.hypotheses; ++i) {
    std::array<Eigen::Vector3d, 3> p;
    for (auto& point : p) point = candidates_[static_cast<std::uint32_t>(random()) % size];
    const Eigen::Vector3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
    if (cross.norm() < 1e-6) continue;
    GroundPlane plane;
    plane.normal = cross.normalized();
    if (plane.normal.dot(up) < 0) plane.normal = -plane.normal;
    plane.height_m = -plane.normal.dot(p[0]);
    if (!plausible(plane, up)) continue;
    plane.inliers = count(plane, candidates_);
    if (!best || plane.inliers > best->inliers) best = plane;
  }
  if (!best || best->inliers < options_.fewest_inliers || !stands_out(*best)) return std::nullopt;
  return best;
}

// A layer of points, and not a slice of walls: these go on above it.
bool GroundFinder::stands_out(const GroundPlane& plane) const {
  GroundPlane above = plane;
  above.height_m -= kSliceAbove * options_.inlier_m;
  return plane.inliers > kLeastContrast * (count(above, candidates_) + count(above, above_));
}

int GroundFinder::count(const GroundPlane& plane,
                        const std::vector<Eigen::Vector3d>& points_m) const {
  return static_cast<int>(std::ranges::count_if(points_m, [&](const Eigen::Vector3d& p) {
    return std::abs(distance(plane, p)) < options_.inlier_m;
  }));
}

// The least-squares plane of the inliers.
std::optional<GroundPlane> GroundFinder::refine(const GroundPlane& start) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int inliers = 0;
  for (const Eigen::Vector3d& p : candidates_) {
    if (std::abs(distance(start, p)) >= options_.inlier_m) continue;
    ++inliers;
    mean += p;
    squares += p * p.transpose();
  }
  if (inliers < options_.fewest_inliers) return std::nullopt;
  mean /= inliers;
  const Eigen::Matrix3d covariance = squares / inliers - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  GroundPlane plane;
  plane.normal = eigen.eigenvectors().col(0);
  if (plane.normal.dot(start.normal) < 0) plane.normal = -plane.normal;
  plane.height_m = -plane.normal.dot(mean);
  plane.inliers = inliers;
  return plane;
}

}  // namespace glint::slam
