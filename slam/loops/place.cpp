// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/place.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include "slam/loops/voxel_key.hpp"

namespace glint::slam {
namespace {

// The numbers of the strongest corners, the strongest first.
std::vector<std::size_t> strongest(const Features& features, std::size_t most) {
  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return features.keypoints[a].response > features.keypoints[b].response;
  });
  order.resize(std::min(order.size(), most));
  return order;
}

// The first point of each voxel.
void thin(std::vector<Eigen::Vector3f>& points_m, float voxel_m) {
  std::unordered_set<std::uint64_t> taken;
  taken.reserve(points_m.size());
  std::erase_if(points_m, [&](const Eigen::Vector3f& point_m) {
    return !taken.insert(voxel_key(point_m, voxel_m)).second;
  });
}

}  // namespace

Place make_place(const Keyframe& keyframe, const PlaceOptions& options) {
  Place place;
  place.id = keyframe.id;
  place.segment = keyframe.estimate.segment;
  place.T_odom_sensor = keyframe.estimate.T_odom_sensor;
  for (const std::size_t i : strongest(keyframe.features, options.most_keypoints)) {
    place.descriptors.push_back(keyframe.features.descriptors[i]);
    place.keypoints_m.push_back(keyframe.features.points_m[i].cast<float>());
  }
  place.points_m.reserve(keyframe.points.size());
  for (const MapPoint& point : keyframe.points) {
    place.points_m.emplace_back(point.x_m, point.y_m, point.z_m);
  }
  place.voxel_m = options.finest_voxel_m;
  thin(place.points_m, place.voxel_m);
  while (place.points_m.size() > options.most_points) {
    place.voxel_m *= 1.2F;
    thin(place.points_m, place.voxel_m);
  }
  place.points_m.shrink_to_fit();
  return place;
}

std::vector<Eigen::Vector3f> points_of(std::span<const Place> places, const Pose& T_frame_odom) {
  std::vector<Eigen::Vector3f> points_m;
  std::size_t count = 0;
  for (const Place& place : places) count += place.points_m.size();
  points_m.reserve(count);
  for (const Place& place : places) {
    const Pose T_frame_place = T_frame_odom * place.T_odom_sensor;
    const Eigen::Matrix3f rotation = T_frame_place.rotation.toRotationMatrix().cast<float>();
    const Eigen::Vector3f translation_m = T_frame_place.translation_m.cast<float>();
    for (const Eigen::Vector3f& point_m : place.points_m) {
      points_m.emplace_back(rotation * point_m + translation_m);
    }
  }
  return points_m;
}

}  // namespace glint::slam
