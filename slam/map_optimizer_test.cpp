// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_optimizer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "slam/test_box_room.hpp"
#include "slam/test_painted_tunnel.hpp"

namespace glint::slam {
namespace {

class MapOptimizerTest : public testing::Test {
 protected:
  void start(const SlamConfig& config) {
    optimizer_ = std::make_unique<MapOptimizer>(info_, config, std::make_shared<XyzLut>(info_));
  }
  void observe(const Pose& T_room_sensor) {
    const LidarScan scan = test::scan_room(info_, T_room_sensor);
    former_.form(scan, images_);
    const std::vector<Pose> still(config_.deskew ? scan.column_time.size() : 0);
    optimizer_->observe(images_, still, Eigen::Vector3d::UnitZ());
  }
  void remember(const Pose& T_room_sensor, const Twist& velocity = Twist::Zero()) {
    observe(T_room_sensor);
    optimizer_->remember({}, {}, T_room_sensor, velocity);
  }
  static Pose pose(double x_m, double y_m, double yaw_rad) {
    return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())),
            {x_m, y_m, -0.4}};
  }

  const SensorInfo info_ = test::room_sensor();
  SlamConfig config_;
  ImageFormer former_{info_, config_};
  ScanImages images_;
  std::unique_ptr<MapOptimizer> optimizer_;
};

class EachPreset : public MapOptimizerTest, public testing::WithParamInterface<const char*> {};

TEST_P(EachPreset, TheMapsWallsPutAScanInItsPlace) {
  config_ = preset_config(GetParam());
  start(config_);
  for (int i = 0; i < 5; ++i) remember(pose(0.1 * i, 0.05 * i, 0.02 * i));
  const Pose truth = pose(0.5, 0.25, 0.1);
  observe(truth);
  const Pose drifted =
      truth * se3_exp((Twist() << 0.08, -0.06, 0.04, 0.01, -0.01, 0.01).finished());
  const MapOptimization result = optimizer_->optimize({}, {}, drifted);
  ASSERT_TRUE(result.ok);
  const Pose error = truth.inverse() * result.T_odom_scan;
  EXPECT_LT(error.translation_m.norm(), 0.01);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.002);
  EXPECT_GT(result.overlap, 0.9);
  EXPECT_LT(result.plane_rms_m, 0.02);
}

TEST_P(EachPreset, TheGroundIsToldApart) {
  config_ = preset_config(GetParam());
  start(config_);
  observe(pose(0.0, 0.0, 0.0));
  ASSERT_TRUE(optimizer_->ground());
  EXPECT_NEAR(optimizer_->ground()->height_m, 1.1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Presets, EachPreset, testing::Values("paper", "full"));

TEST_F(MapOptimizerTest, WithoutAMapNothingIsSaid) {
  start(config_);
  observe(pose(0.0, 0.0, 0.0));
  EXPECT_FALSE(optimizer_->optimize({}, {}, pose(0.0, 0.0, 0.0)).ok);
  remember(pose(0.0, 0.0, 0.0));
  observe(pose(0.0, 0.0, 0.0));
  EXPECT_TRUE(optimizer_->optimize({}, {}, pose(0.0, 0.0, 0.0)).ok);
  optimizer_->reset();
  EXPECT_EQ(optimizer_->map().size(), 0U);
  EXPECT_FALSE(optimizer_->optimize({}, {}, pose(0.0, 0.0, 0.0)).ok);
}

TEST_F(MapOptimizerTest, PlanesMayBeSwitchedOff) {
  config_.planes = false;
  start(config_);
  remember(pose(0.0, 0.0, 0.0));
  EXPECT_EQ(optimizer_->map().size(), 0U);
  EXPECT_FALSE(optimizer_->ground());
}

TEST_F(MapOptimizerTest, WhatTurningDisplacedStaysOutOfTheMap) {
  // At 1 rad/s a point 5 m away is displaced by up to 0.25 m within half a turn of the beams.
  const Twist turning = (Twist() << 0, 0, 0, 0, 0, 1.0).finished();
  const auto map_size = [&](bool deskew, const Twist& velocity) {
    config_.deskew = deskew;
    start(config_);
    remember(pose(0.0, 0.0, 0.0), velocity);
    return optimizer_->map().size();
  };
  const std::size_t all = map_size(false, Twist::Zero());
  EXPECT_LT(map_size(false, turning), 0.8 * static_cast<double>(all));
  EXPECT_GT(map_size(false, turning), 0.2 * static_cast<double>(all));
  EXPECT_EQ(map_size(true, turning), map_size(true, Twist::Zero()));
}

// What a prior says of axes that surfaces hold counts as much as it is sure.
TEST_F(MapOptimizerTest, ASurePriorPullsTheScanAndAnUnsureOneDoesNot) {
  start(config_);
  for (int i = 0; i < 5; ++i) remember(pose(0.0, 0.0, 0.0));
  const Pose truth = pose(0.0, 0.0, 0.0);
  observe(truth);
  PosePrior prior;
  prior.T_odom_scan = pose(0.01, 0.0, 0.0);
  const auto found_m = [&](double sigma_m) {
    prior.held_information.diagonal().head<3>().setConstant(1.0 / (sigma_m * sigma_m));
    return optimizer_->optimize({}, {}, truth, prior).T_odom_scan.translation_m.x();
  };
  EXPECT_LT(found_m(1.0), 0.002);
  EXPECT_GT(found_m(1e-5), 0.009);
}

TEST_F(MapOptimizerTest, LargeRebuildsLeaveTheResultToTheScansAlone) {
  const auto walk = [&] {
    start(config_);
    std::vector<double> x_m;
    for (int i = 0; i < 60; ++i) {
      // Ever farther from the room it is in: the map grows to one side.
      const Pose T_room_sensor = pose(0.02 * i, 0.0, 0.0);
      Pose elsewhere = T_room_sensor;
      elsewhere.translation_m.x() += 0.8 * i;
      observe(T_room_sensor);
      optimizer_->remember({}, {}, elsewhere, Twist::Zero());
      observe(T_room_sensor);
      x_m.push_back(optimizer_->optimize({}, {}, elsewhere).T_odom_scan.translation_m.x());
    }
    EXPECT_GT(optimizer_->map().size(), 6000U);
    return x_m;
  };
  EXPECT_EQ(walk(), walk());
}

// In a round tunnel with rings on its wall, which alone tell the way along it.
class MapOptimizerInTunnel : public MapOptimizerTest {
 protected:
  void observe_at(double x_m) {
    test::see_tunnel(info_, *lut_, along(x_m), test::rings, images_);
    optimizer_->observe(images_, still_, Eigen::Vector3d::UnitZ());
  }
  static Pose along(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.4, -0.5}}; }
  // Of a scan at 0.2 m, for one that the motion so far leads to 0, as sure as that.
  MapOptimization optimize_at_20_cm(double sigma_m, double held_sigma_m = 1.0) {
    PosePrior prior;
    prior.held_information.diagonal().head<3>().setConstant(1.0 / (held_sigma_m * held_sigma_m));
    prior.T_odom_scan = along(0.0);
    prior.information.diagonal().head<3>().setConstant(1.0 / (sigma_m * sigma_m));
    prior.information.diagonal().tail<3>().setConstant(1e6);
    prior.turn_is_measured = true;
    start(config_);
    for (int i = 0; i < 4; ++i) {
      observe_at(0.0);
      optimizer_->optimize({}, {}, along(0.0), prior);
      optimizer_->remember({}, {}, along(0.0), Twist::Zero());
    }
    observe_at(0.2);
    return optimizer_->optimize({}, {}, along(0.0), prior);
  }

  const std::shared_ptr<const XyzLut> lut_ = std::make_shared<XyzLut>(info_);
  const std::vector<Pose> still_{static_cast<std::size_t>(info_.columns_per_frame)};
};

TEST_F(MapOptimizerInTunnel, PatchesThatAgreeWithTheMotionTellTheWay) {
  const MapOptimization result = optimize_at_20_cm(0.2);
  ASSERT_TRUE(result.ok);
  EXPECT_FALSE(result.weak_axes.empty());
  EXPECT_FALSE(result.weak_axes.any_critical());
  EXPECT_NEAR(result.T_odom_scan.translation_m.x(), 0.2, 0.02);
}

// However sure it would be of an axis that surfaces held.
TEST_F(MapOptimizerInTunnel, WhereSurfacesHoldNothingTheHeldPriorHasNoSay) {
  const MapOptimization result = optimize_at_20_cm(0.2, 1e-4);
  ASSERT_TRUE(result.ok);
  EXPECT_NEAR(result.T_odom_scan.translation_m.x(), 0.2, 0.02);
}

TEST_F(MapOptimizerInTunnel, PatchesThatContradictTheMotionAreNotBelieved) {
  const MapOptimization result = optimize_at_20_cm(0.05);
  ASSERT_TRUE(result.ok);
  EXPECT_EQ(result.patch_terms, 0);
  EXPECT_TRUE(result.weak_axes.any_critical());
  EXPECT_NEAR(result.T_odom_scan.translation_m.x(), 0.0, 0.02);
}

}  // namespace
}  // namespace glint::slam
