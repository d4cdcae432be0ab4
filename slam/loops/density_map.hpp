// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "slam/features.hpp"
#include "slam/loops/place.hpp"

namespace glint::slam {

/// What is kept of a local map seen from above: corners of its walls and things. Positions are
/// in the upright frame of its keyframe: origin at the sensor, axes those of the odometry frame.
/// Entry i of each vector belongs together. Value type.
struct DensityMap {
  float cell_m = 0.0F;   ///< Maps with other cells are not compared.
  float floor_m = 0.0F;  ///< Height of the floor.
  std::vector<Descriptor> descriptors;
  std::vector<Eigen::Vector2f> at_m;
  std::vector<float> angle_rad;  ///< Direction of each corner, anticlockwise from x.
};

struct DensityOptions {
  int most_corners = 200;
  float finest_cell_m = 0.2F;
  float coarsest_cell_m = 0.8F;
};

/// The points of a few keyframes from above: how much stands in each cell, 0 to 255. Row 0 has the
/// least y, column 0 the least x.
struct DensityImage {
  cv::Mat1b grey;
  float cell_m = 0.0F;
  float floor_m = 0.0F;
  Eigen::Vector2f corner_m = Eigen::Vector2f::Zero();  ///< Of pixel (0, 0).
};

/// `around` holds `base` and keyframes next to it, of one segment.
DensityImage make_density_image(const Place& base, std::span<const Place> around,
                                const DensityOptions& options = {});
/// ORB on the density image of the local map [the idea of Gupta et al. 2024, "Effectively Detecting
/// Loop Closures using Point Cloud Density Maps"]: heading does not matter, nor do beams.
DensityMap make_density_map(const Place& base, std::span<const Place> around,
                            const DensityOptions& options = {});

}  // namespace glint::slam
