// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/cold_array.hpp"
#include "slam/cold_file.hpp"
#include "slam/features.hpp"
#include "slam/keyframe.hpp"

namespace glint::slam {

/// What is kept of a keyframe to find its place again: some 50 kB at most. Value type.
struct Place {
  std::uint64_t id = 0;  ///< Of the keyframe.
  std::uint32_t segment = 0;
  double time_s = 0.0;  ///< Since the first keyframe.
  double path_m = 0.0;  ///< Way travelled until then.
  Pose T_odom_sensor;
  /// Keypoints, the strongest first; entry i of each belongs together. Sensor frame, m.
  ColdArray<Descriptor> descriptors;
  ColdArray<Eigen::Vector3f> keypoints_m;
  /// Points all around, one in each cube of edge voxel_m. Sensor frame, m.
  ColdArray<Eigen::Vector3f> points_m;
  float voxel_m = 0.0F;
  bool known = false;  ///< An older one shows all of it: it is not kept for long.
};

struct PlaceOptions {
  std::size_t most_keypoints = 500;  ///< The strongest corners.
  std::size_t most_points = 2000;
  float finest_voxel_m = 0.25F;  ///< Points are thinned to one a voxel at least this large.
};

/// The descriptors that a place of these keypoints has, in its order.
std::vector<Descriptor> place_descriptors(const Features& features,
                                          const PlaceOptions& options = {});
/// Keeps the strongest keypoints and thinned points of a keyframe; leaves time and path at zero.
Place make_place(const Keyframe& keyframe, const PlaceOptions& options = {});

/// What a place takes in memory, about, bytes.
std::size_t bytes_of(const Place& place);
/// Puts what it shows into the file, unless that takes no more; it is read as before.
void set_aside(Place& place, ColdFile& file);

/// The points of `places`, all of one segment, in a frame that the odometry's is known in; m.
std::vector<Eigen::Vector3f> points_of(std::span<const Place> places, const Pose& T_frame_odom);

}  // namespace glint::slam
