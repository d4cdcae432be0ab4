// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"
#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

/// Straight galleries along x, 30 m long, 3 m wide and high, 40 m apart along y, for tests: their
/// walls have the same marks, and each its own pictures. The first `pictured` have pictures.
class TestGallery {
 public:
  static constexpr double kLength_m = 30.0;
  static constexpr double kApart_m = 40.0;

  explicit TestGallery(int galleries = 1, int pictured = 1);

  /// What a sensor sees there. Descriptors and points differ a little each time.
  Keyframe look(const Pose& T_world_sensor, std::uint64_t id, double time_s);
  /// A vocabulary trained on these galleries.
  Vocabulary vocabulary();

 private:
  struct Mark {
    Eigen::Vector3d at_m;
    Descriptor descriptor;
  };

  Descriptor random_descriptor();
  double uniform(double low, double high);
  Eigen::Vector3d on_wall();
  void add_points(const Pose& T_world_sensor, Keyframe& keyframe);

  int galleries_;
  std::vector<Mark> marks_;
  std::mt19937_64 random_{11};
};

/// At `x` along the gallery, `y` from its middle line, looking `yaw_rad` to the left of ahead.
Pose gallery_pose(double x_m, double y_m, double yaw_rad, int gallery = 0);

/// The largest error, in m or rad, of loops between keyframes that truly were at `truths`.
double worst_error(std::span<const LoopEdge> edges, std::span<const Pose> truths);

}  // namespace glint::slam
