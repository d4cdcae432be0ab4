// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/place.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

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

std::vector<Descriptor> place_descriptors(const Features& features, const PlaceOptions& options) {
  std::vector<Descriptor> descriptors;
  for (const std::size_t i : strongest(features, options.most_keypoints)) {
    descriptors.push_back(features.descriptors[i]);
  }
  return descriptors;
}

Place make_place(const Keyframe& keyframe, const PlaceOptions& options) {
  Place place;
  place.id = keyframe.id;
  place.segment = keyframe.estimate.segment;
  place.T_odom_sensor = keyframe.estimate.T_odom_sensor;
  std::vector<Descriptor> descriptors;
  std::vector<Eigen::Vector3f> keypoints_m;
  for (const std::size_t i : strongest(keyframe.features, options.most_keypoints)) {
    descriptors.push_back(keyframe.features.descriptors[i]);
    keypoints_m.push_back(keyframe.features.points_m[i].cast<float>());
  }
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(keyframe.points.size());
  for (const MapPoint& point : keyframe.points) {
    points_m.emplace_back(point.x_m, point.y_m, point.z_m);
  }
  place.voxel_m = options.finest_voxel_m;
  thin(points_m, place.voxel_m);
  while (points_m.size() > options.most_points) {
    place.voxel_m *= 1.2F;
    thin(points_m, place.voxel_m);
  }
  points_m.shrink_to_fit();
  place.descriptors = std::move(descriptors);
  place.keypoints_m = std::move(keypoints_m);
  place.points_m = std::move(points_m);
  return place;
}

std::size_t bytes_of(const Place& place) {
  std::size_t bytes = sizeof(Place);
  const auto add = [&](const auto& values) {
    if (!values.is_cold()) bytes += values.size() * sizeof(values[0]);
  };
  add(place.descriptors);
  add(place.keypoints_m);
  add(place.points_m);
  return bytes;
}

void set_aside(Place& place, ColdFile& file) {
  const auto put = [&](auto& values) {
    if (values.is_cold() || values.empty()) return;
    const auto bytes = file.put(std::as_bytes(std::span(values.data(), values.size())));
    if (bytes) values = {bytes, values.size()};
  };
  put(place.descriptors);
  put(place.keypoints_m);
  put(place.points_m);
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
