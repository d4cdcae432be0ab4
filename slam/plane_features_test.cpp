// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/plane_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "slam/scan_motion.hpp"
#include "slam/test_box_room.hpp"

namespace glint::slam {
namespace {

using test::distance_from_edges;
using test::distance_from_room;

class PlaneExtractorTest : public testing::Test {
 protected:
  const std::vector<Eigen::Vector3f>& extract(const SensorInfo& info, const LidarScan& scan,
                                              std::span<const Pose> T_reference_column = {}) {
    PlaneFeatureOptions options;
    options.wanted_points = 800;
    extractor_ = std::make_unique<PlaneExtractor>(info, options, std::make_shared<XyzLut>(info));
    ImageFormer(info, {}).form(scan, images_);
    // The voxels find their size within some scans.
    for (int i = 0; i < 8; ++i) extractor_->extract(images_, T_reference_column);
    return extractor_->extract(images_, T_reference_column);
  }

  const SensorInfo info_ = test::room_sensor();
  const Pose T_room_sensor_{Eigen::Quaterniond::Identity(), {1.0, -0.5, -0.3}};
  std::unique_ptr<PlaneExtractor> extractor_;
  ScanImages images_;
};

TEST_F(PlaneExtractorTest, AboutAsManyPointsAsWantedAllOnSurfaces) {
  const auto& points = extract(info_, test::scan_room(info_, T_room_sensor_));
  EXPECT_GT(points.size(), 500U);
  EXPECT_LT(points.size(), 1300U);
  for (const Eigen::Vector3f& point : points) {
    EXPECT_LT(distance_from_room(T_room_sensor_ * point.cast<double>()), 0.002);
  }
}

TEST_F(PlaneExtractorTest, WhereSurfacesMeetNoneIsTaken) {
  // Level beams of which each crosses the room's four upright edges.
  const SensorInfo info = test::room_sensor({3.0, 2.0, 1.0, 0.0, -1.0, -2.0, -3.0, -4.0});
  const auto& points = extract(info, test::scan_room(info, T_room_sensor_));
  ASSERT_GT(points.size(), 100U);
  for (const Eigen::Vector3f& point : points) {
    EXPECT_GT(distance_from_edges(T_room_sensor_ * point.cast<double>()), 0.03);
  }
}

TEST_F(PlaneExtractorTest, AnyTableOfBeamsHasTrueRings) {
  // Dense around the horizon, and all of them above it.
  for (const auto& table :
       {std::vector<double>{30, 12, 4, 2, 1, 0.5, 0, -0.5, -1, -2, -4, -12, -30},
        std::vector<double>{80, 60, 40, 30, 20, 15, 10, 8, 6, 4, 2, 1, 0.2}}) {
    const SensorInfo info = test::room_sensor(table);
    const auto& points = extract(info, test::scan_room(info, T_room_sensor_));
    EXPECT_GT(points.size(), 200U);
    for (const Eigen::Vector3f& point : points) {
      EXPECT_LT(distance_from_room(T_room_sensor_ * point.cast<double>()), 0.002);
    }
  }
}

TEST_F(PlaneExtractorTest, BesideAHoleNothingIsKnown) {
  LidarScan scan = test::scan_room(info_, T_room_sensor_);
  // Every eighth measurement is missing: no point has its ten neighbours.
  for (int row = 0; row < info_.pixels_per_column; ++row) {
    for (int m = 0; m < info_.columns_per_frame; m += 8) scan.range_mm(row, m) = 0;
  }
  EXPECT_TRUE(extract(info_, scan).empty());
}

TEST_F(PlaneExtractorTest, MotionBringsPointsToOneInstant) {
  // Each column is measured from where the sensor then is; the reference is the scan's end.
  const Twist velocity = (Twist() << 2.0, -1.0, 0.0, 0.0, 0.0, 0.8).finished();
  const SensorTime end = SensorTime{0} + info_.scan_period_ns();
  const ScanMotion motion({velocity, Eigen::Vector3d::Zero()}, end, info_.scan_period_ns());
  LidarScan scan = test::scan_room(info_, T_room_sensor_);
  for (int first = 0; first < info_.columns_per_frame; first += 8) {
    const SensorTime middle = scan.column_time[static_cast<std::size_t>(first + 4)];
    const LidarScan there = test::scan_room(info_, T_room_sensor_ * motion.at(middle));
    for (int row = 0; row < info_.pixels_per_column; ++row) {
      for (int m = first; m < first + 8; ++m) scan.range_mm(row, m) = there.range_mm(row, m);
    }
  }
  const auto farthest_m = [&](const std::vector<Eigen::Vector3f>& points) {
    double worst_m = 0.0;
    for (const Eigen::Vector3f& point : points) {
      worst_m = std::max(worst_m, distance_from_room(T_room_sensor_ * point.cast<double>()));
    }
    return worst_m;
  };
  EXPECT_GT(farthest_m(extract(info_, scan)), 0.15);
  std::vector<Pose> T_reference_column;
  place_columns(motion, scan.column_time, T_reference_column);
  EXPECT_LT(farthest_m(extract(info_, scan, T_reference_column)), 0.02);
}

TEST_F(PlaneExtractorTest, AnEmptyScanHasNoSurfaces) {
  const LidarScan nothing{PacketFormat(info_)};
  EXPECT_TRUE(extract(info_, nothing).empty());
}

}  // namespace
}  // namespace glint::slam
