// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/backend.hpp"
#include "slam/loops/test_gallery.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam::test {

/// A test with a gallery and a robot in it, whose keyframes come every half second. Places are
/// found by appearance; what finds loops is not asked.
class GalleryRobot : public InDirectory {
 protected:
  GalleryRobot() {
    config_.map_voxel_m = 0.2;
    loops_.search = [](const Keyframe&) { return LoopSearch{}; };
  }

  /// The robot's next keyframe; its odometry has the gallery's frame at `T_odom_world`.
  Keyframe seen(const Pose& truth, const Pose& T_odom_world, std::uint32_t segment = 0) {
    Keyframe keyframe = gallery_.look(truth, next_, 0.5 * static_cast<double>(next_));
    keyframe.estimate.sequence = 5 * next_++;
    keyframe.estimate.segment = segment;
    keyframe.estimate.T_odom_sensor = T_odom_world * truth;
    keyframe.edge_covariance.diagonal().setConstant(1e-6);
    return keyframe;
  }
  /// On the way back, the other way round.
  static Pose back_at(int k) { return gallery_pose(14.0 - 0.4 * k, -0.2, M_PI); }
  /// By how much the back end has a keyframe elsewhere in the map than it was.
  static double error_m(const Backend& backend, const Keyframe& keyframe, const Pose& truth) {
    const OdometryEstimate& e = keyframe.estimate;
    const Pose pose =
        backend.correction().map_pose(e.segment, static_cast<double>(e.sequence), e.T_odom_sensor);
    return (pose.translation_m - truth.translation_m).norm();
  }

  SlamConfig config_;
  LoopSource loops_;
  TestGallery gallery_;
  std::uint64_t next_ = 0;
  const std::filesystem::path map_file_ = directory_ / "map.glint";
  const std::filesystem::path later_file_ = directory_ / "later.glint";
  const Pose T_odom_world_{so3_exp({0.0, 0.0, 1.0}), {50.0, -20.0, 3.0}};
};

}  // namespace glint::slam::test
