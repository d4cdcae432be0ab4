// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/test_gallery.hpp"

#include <algorithm>
#include <cmath>

#include "slam/loops/vocabulary_trainer.hpp"

namespace glint::slam {
namespace {

constexpr double kHalfWidth_m = 1.5;
constexpr double kFloor_m = -1.0;
constexpr double kCeiling_m = 2.0;
constexpr double kFarthest_m = 9.0;
constexpr int kMarks = 700;
constexpr int kPictureMarks = 25;
constexpr double kPicturesApart_m = 4.0;

}  // namespace

Pose gallery_pose(double x_m, double y_m, double yaw_rad, int gallery) {
  Pose pose;
  pose.rotation = so3_exp({0.0, 0.0, yaw_rad});
  pose.translation_m = {x_m, y_m + gallery * TestGallery::kApart_m, 0.0};
  return pose;
}

TestGallery::TestGallery(int galleries, int pictured) : galleries_(galleries) {
  for (int i = 0; i < kMarks; ++i) {
    const Mark mark{on_wall(), random_descriptor()};
    for (int gallery = 0; gallery < galleries; ++gallery) {
      marks_.push_back(
          {mark.at_m + gallery * kApart_m * Eigen::Vector3d::UnitY(), mark.descriptor});
    }
  }
  for (int gallery = 0; gallery < pictured; ++gallery) {
    for (double x_m = 2.0; x_m < kLength_m; x_m += kPicturesApart_m) {
      const double side = uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
      for (int i = 0; i < kPictureMarks; ++i) {
        marks_.push_back(
            {{x_m + uniform(0.0, 0.7), side * kHalfWidth_m + gallery * kApart_m, uniform(0.2, 0.9)},
             random_descriptor()});
      }
    }
  }
}

Descriptor TestGallery::random_descriptor() {
  Descriptor descriptor;
  for (auto& word : descriptor) word = random_();
  return descriptor;
}

double TestGallery::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(random_() % 1000000) * 1e-6;
}

Eigen::Vector3d TestGallery::on_wall() {
  const double side = random_() % 2 == 0 ? -1.0 : 1.0;
  return {uniform(0.0, kLength_m), side * kHalfWidth_m, uniform(kFloor_m, kCeiling_m)};
}

Keyframe TestGallery::look(const Pose& T_world_sensor, std::uint64_t id, double time_s) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.estimate.stamp = SensorTime{static_cast<std::int64_t>(time_s * 1e9)};
  keyframe.estimate.T_odom_sensor = T_world_sensor;
  const Pose T_sensor_world = T_world_sensor.inverse();
  for (const Mark& mark : marks_) {
    const Eigen::Vector3d point_m = T_sensor_world * mark.at_m;
    if (point_m.norm() > kFarthest_m || uniform(0.0, 1.0) < 0.1) continue;
    Descriptor descriptor = mark.descriptor;
    for (int i = 0; i < 10; ++i) {
      const std::uint64_t bit = random_() % 256;
      descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    }
    keyframe.features.keypoints.emplace_back();
    keyframe.features.keypoints.back().response = static_cast<float>(mark.descriptor[0] % 1000);
    keyframe.features.descriptors.push_back(descriptor);
    keyframe.features.points_m.push_back(point_m + Eigen::Vector3d(uniform(-0.03, 0.03),
                                                                   uniform(-0.03, 0.03),
                                                                   uniform(-0.03, 0.03)));
  }
  add_points(T_world_sensor, keyframe);
  return keyframe;
}

void TestGallery::add_points(const Pose& T_world_sensor, Keyframe& keyframe) {
  const Pose T_sensor_world = T_world_sensor.inverse();
  const double middle_y = kApart_m * std::round(T_world_sensor.translation_m.y() / kApart_m);
  for (int i = 0; i < 4000; ++i) {
    const double x_m = T_world_sensor.translation_m.x() + uniform(-10.0, 10.0);
    Eigen::Vector3d at_m(x_m, middle_y, 0.0);
    switch (random_() % 4) {
      case 0:
        at_m += Eigen::Vector3d(0.0, kHalfWidth_m, uniform(kFloor_m, kCeiling_m));
        break;
      case 1:
        at_m += Eigen::Vector3d(0.0, -kHalfWidth_m, uniform(kFloor_m, kCeiling_m));
        break;
      case 2:
        at_m += Eigen::Vector3d(0.0, uniform(-kHalfWidth_m, kHalfWidth_m), kFloor_m);
        break;
      default:
        at_m += Eigen::Vector3d(0.0, uniform(-kHalfWidth_m, kHalfWidth_m), kCeiling_m);
    }
    const Eigen::Vector3f point_m = (T_sensor_world * at_m).cast<float>();
    keyframe.points.push_back({point_m.x(), point_m.y(), point_m.z(), 100.0F});
  }
}

Vocabulary TestGallery::vocabulary() {
  std::vector<std::vector<Descriptor>> images;
  for (int gallery = 0; gallery < galleries_; ++gallery) {
    for (double x_m = 0.0; x_m < kLength_m; x_m += 2.0) {
      images.push_back(look(gallery_pose(x_m, 0.0, 0.0, gallery), 0, 0.0).features.descriptors);
    }
  }
  return train_vocabulary(images, {.branching = 10, .depth = 3, .rounds = 4});
}

double worst_error(std::span<const LoopEdge> edges, std::span<const Pose> truths) {
  double worst = 0.0;
  for (const LoopEdge& edge : edges) {
    const Pose truth = truths[edge.from].inverse() * truths[edge.to];
    const Pose error = truth.inverse() * edge.T_from_to;
    worst = std::max({worst, error.translation_m.norm(), so3_log(error.rotation).norm()});
  }
  return worst;
}

}  // namespace glint::slam
