// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/config.hpp"
#include "slam/degeneracy.hpp"
#include "slam/features.hpp"
#include "slam/ground.hpp"
#include "slam/joint_optimizer.hpp"
#include "slam/matching.hpp"
#include "slam/patch_tracker.hpp"
#include "slam/plane_features.hpp"
#include "slam/plane_map.hpp"
#include "slam/scan_images.hpp"
#include "slam/window_ba.hpp"

namespace glint::slam {

/// What map optimisation makes of the odometry's pose. Value type.
struct MapOptimization {
  bool ok = false;  ///< False: keep the pose that odometry gave.
  Pose T_odom_scan;
  /// Translation then rotation, right perturbation, m^2 and rad^2.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  int plane_terms = 0;
  double overlap = 0.0;      ///< Share of the scan's surface points that found a plane.
  double plane_rms_m = 0.0;  ///< Of their distances to it.
  int point_terms = 0;
  int patch_terms = 0;
  /// What the surfaces leave open, and which of it the keypoints do too.
  WeakAxes weak_axes;
};

/// Corrects the odometry's drift: the scan's surfaces against those of the local map, and its
/// keypoints against the last scans', in one problem [Du & Beltrame 2023, sec. III-B, "Map
/// Optimization"]. Thread-compatible; owned by the odometry thread.
class MapOptimizer {
 public:
  MapOptimizer(const SensorInfo& info, const SlamConfig& config, std::shared_ptr<const XyzLut> lut);

  /// Takes a scan's surfaces and parts the ground from them. The poses of its columns bring its
  /// points to one instant; none: it is taken as rigid. `up` is in the scan frame. Images and poses
  /// are to stay as they are until remember() or the next scan.
  void observe(const ScanImages& images, std::span<const Pose> T_reference_column,
               const Eigen::Vector3d& up);
  /// The pose of the observed scan, which odometry places at `start`; `matches` are the keypoints
  /// that odometry could match, none if it could not. `prior`: where the motion before leads, in
  /// 1/m^2 and 1/rad^2.
  MapOptimization optimize(const Features& features, const std::vector<Match>& matches,
                           const Pose& start, const std::optional<PosePrior>& prior = {});
  /// Takes the observed scan into map and window, at its final pose. Of a scan that is taken as
  /// rigid, what the sensor's turning displaced while it was measured is left out of the map.
  void remember(const Features& features, const std::vector<Match>& matches,
                const Pose& T_odom_scan, const Twist& velocity);
  /// About so many points on surfaces are taken from the next scans.
  void set_plane_points(int points) { extractor_.set_wanted(points); }
  /// Whether new pieces of the image are looked for in every second scan only, where enough are.
  void set_sparing_patches(bool sparing) {
    if (patches_) patches_->set_sparing(sparing);
  }
  /// Forgets map and window.
  void reset();

  [[nodiscard]] const PlaneMap& map() const { return *map_; }
  /// The ground of the observed scan, if it shows any.
  [[nodiscard]] const std::optional<GroundPlane>& ground() const { return ground_plane_; }

 private:
  [[nodiscard]] double unit_variance_m2(const JointResult& result) const;
  void weigh_keypoints(const Pose& pose);
  void leave_open(const Pose& pose, JointTerms& terms, WeakAxes& weak) const;
  [[nodiscard]] Pose place_by_patches(const Pose& pose, const WeakAxes& weak,
                                      const std::optional<PosePrior>& prior);
  void ask_patches(const Pose& pose, const WeakAxes& weak, JointTerms& terms);
  void associate_keypoints(const Features& features, const std::vector<Match>& matches,
                           const Pose& pose);
  void drop_displaced(const Eigen::Vector3d& turn_radps);
  [[nodiscard]] double seconds_from_middle(const Eigen::Vector3f& point_m) const;
  [[nodiscard]] bool settled(const Pose& from, const Pose& to) const;

  const SlamConfig config_;
  Eigen::Vector2d middle_;   ///< Horizontal direction of the scan's middle column, unit length.
  double turn_radps_ = 0.0;  ///< Of the beams; positive counter-clockwise.
  PlaneExtractor extractor_;
  GroundFinder ground_finder_;
  std::unique_ptr<PlaneMap> map_;
  SlidingWindow window_;
  std::optional<PatchTracker> patches_;
  PatchVotes votes_;            ///< On the scan's pose; none without patches.
  bool patches_agree_ = false;  ///< With the motion so far.
  WeakAxes weak_before_;        ///< Of the last optimised scan.

  std::vector<Eigen::Vector3f> points_m_;  ///< Of the scan; those on the ground first.
  std::size_t ground_count_ = 0;
  bool rigid_ = false;
  std::optional<GroundPlane> ground_plane_;
  std::vector<PlaneTerm> planes_;
  std::vector<PointTerm> points_;
  double keypoint_weight_ = 1.0;  ///< What their weights were multiplied with.
  std::vector<double> residuals_m_;
};

}  // namespace glint::slam
