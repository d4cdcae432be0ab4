// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/features.hpp"
#include "slam/joint_terms.hpp"
#include "slam/matching.hpp"

namespace glint::slam {

struct WindowOptions {
  int frames = 10;            ///< k of the paper, which gives no number.
  int max_hamming_bits = 64;  ///< Largest distance of two descriptors that may be one point.
  double gate_m = 0.3;        ///< Farther apart in the odometry frame they are not.
  /// One residual a keypoint, against the mean of where the frames saw it: what is wrong with how
  /// the current scan sees it counts once, not in each frame's residual.
  bool means = false;
};

/// The sliding window of the paper's LiDAR bundle adjustment: the keypoints of the last k frames,
/// whose poses are fixed, give one residual for each keypoint of the current scan that they show
/// [Du & Beltrame 2023, sec. III-B]. Only keypoints that the front end could match take part.
/// Thread-compatible.
class SlidingWindow {
 public:
  explicit SlidingWindow(WindowOptions options) : options_(options) {}

  /// The point terms of the current scan, seen from about T_odom_scan. Valid until the next call.
  const std::vector<PointTerm>& associate(const Features& current,
                                          const std::vector<Match>& front_end_matches,
                                          const Pose& T_odom_scan);
  /// The current scan becomes the newest frame, with its final pose.
  void push(const Features& current, const std::vector<Match>& front_end_matches,
            const Pose& T_odom_scan);
  void clear() { frames_.clear(); }
  [[nodiscard]] std::size_t size() const { return frames_.size(); }

 private:
  struct Frame {
    std::vector<Descriptor> descriptors;
    std::vector<Eigen::Vector3d> fixed_m;  ///< Odometry frame.
    std::vector<float> x_m, y_m, z_m;      ///< The same, for the look for near ones.
  };

  /// The weight of the frame's keypoint that is this one, and where it is; 0 if there is none.
  double look_for(const Descriptor& descriptor, const Eigen::Vector3d& place_m, const Frame& frame,
                  Eigen::Vector3d& fixed_m);
  const std::vector<std::size_t>& near(const Frame& frame, const Eigen::Vector3d& place_m);

  WindowOptions options_;
  std::deque<Frame> frames_;  ///< Oldest first.
  std::vector<PointTerm> terms_;
  std::vector<float> squared_;
  std::vector<std::size_t> near_;
};

}  // namespace glint::slam
