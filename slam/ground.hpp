// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace glint::slam {

struct GroundOptions {
  /// Height of the sensor above the ground, m; 0: that of the dominant low plane.
  double sensor_height_m = 0.0;
  double inlier_m = 0.05;      ///< Of a point to the plane.
  double height_band_m = 0.5;  ///< How far from where it is expected the ground is looked for.
  double largest_tilt_rad = 0.26;
  int hypotheses = 100;
  int largest_sample = 2000;  ///< Points that hypotheses are tried on.
  int fewest_inliers = 60;
};

/// The ground as one scan sees it. Value type.
struct GroundPlane {
  Eigen::Vector3d normal;  ///< Upwards, scan frame, unit length.
  double height_m = 0.0;   ///< Of the sensor above it.
  int inliers = 0;
};

/// Finds the ground in a scan: a plane at about the sensor's height below it and nearly level
/// [Du & Beltrame 2023, sec. III-B], by RANSAC. A height that it found by itself is looked for anew
/// once no ground was there for some seconds. Deterministic. Thread-compatible.
class GroundFinder {
 public:
  explicit GroundFinder(GroundOptions options) : options_(options) {}

  /// `points_m` and `up` in the scan frame. Parts the points: those on the ground are moved to the
  /// front of `points_m`, so many. Null when no plane passes; then none is on the ground.
  std::optional<GroundPlane> find(std::span<Eigen::Vector3f> points_m, const Eigen::Vector3d& up,
                                  std::size_t* ground_count);
  /// Forgets the height that it found by itself.
  void reset() {
    height_m_.reset();
    missed_scans_ = 0;
  }

 private:
  std::optional<GroundPlane> find_plane(std::span<const Eigen::Vector3f> points_m,
                                        const Eigen::Vector3d& up);
  void collect_candidates(std::span<const Eigen::Vector3f> points_m, const Eigen::Vector3d& up);
  std::optional<GroundPlane> sample_planes(const Eigen::Vector3d& up);
  [[nodiscard]] std::optional<GroundPlane> refine(const GroundPlane& start) const;
  [[nodiscard]] bool plausible(const GroundPlane& plane, const Eigen::Vector3d& up) const;
  [[nodiscard]] bool stands_out(const GroundPlane& plane) const;
  [[nodiscard]] int count(const GroundPlane& plane,
                          const std::vector<Eigen::Vector3d>& points_m) const;

  GroundOptions options_;
  std::optional<double> height_m_;  ///< Running.
  int missed_scans_ = 0;            ///< Since a plane passed.
  std::vector<Eigen::Vector3d> candidates_;
  std::vector<Eigen::Vector3d> above_;  ///< Just too high to be candidates.
};

}  // namespace glint::slam
