// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Sensors that hang, tilt and sit beside the robot's centre, in a simulated world.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "pcap/synth/simulator.hpp"
#include "slam/frontend.hpp"

namespace glint::slam {
namespace {

constexpr double kSeconds = 3.0;

synth::SimulationOptions room() {
  synth::SimulationOptions options;
  options.world = "room";
  options.seconds = kSeconds;
  options.seed = 5;
  options.sensor.columns = 512;  // Half a scan's work, as sanitizers make it slow.
  return options;
}

Pose mount(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& lever_m) {
  return {so3_exp(rotation_rad), lever_m};
}

class Mounting : public testing::TestWithParam<Pose> {
 protected:
  // The way of a sensor on a base that walks through the room, as a TUM file.
  void SetUp() override {
    file_ = std::filesystem::path(testing::TempDir()) / fmt::format("mounting_{}.tum", getpid());
    std::ofstream out(file_);
    constexpr double kStep_s = 0.05;
    for (double t = 0.0; t < kSeconds + 1.0; t += kStep_s) {
      const Pose pose = walk_.motion()(t) * GetParam();
      const Eigen::Vector3d& p = pose.translation_m;
      const Eigen::Quaterniond& q = pose.rotation;
      out << fmt::format("{} {} {} {} {} {} {} {}\n", t, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                         q.w());
    }
    ASSERT_TRUE(out.good());
  }
  void TearDown() override { std::filesystem::remove(file_); }

  synth::Simulator walk_{room()};
  std::filesystem::path file_;
};

TEST_P(Mounting, TheBaseIsWhereItIsAndTheMapIsUpright) {
  const Pose T_sensor_base = GetParam().inverse();
  synth::SimulationOptions options = room();
  options.trajectory = file_;
  synth::Simulator simulator(options);
  Frontend frontend(simulator.info(), {}, {}, GetParam().rotation);
  LidarScan scan;
  synth::ScanTruth truth;
  Pose T_odom_world;
  for (int i = 0; simulator.next(scan, truth); ++i) {
    const OdometryEstimate& estimate = frontend.process(scan);
    const Pose T_odom_base = estimate.T_odom_sensor * T_sensor_base;
    const Pose T_world_base = simulator.true_pose(estimate.stamp) * T_sensor_base;
    if (i == 0) {
      EXPECT_LT(so3_log(T_odom_base.rotation).norm(), 1e-9);
      EXPECT_EQ(estimate.T_odom_sensor.translation_m.norm(), 0.0);
      T_odom_world = T_odom_base * T_world_base.inverse();
      // A walker leans a little; more would be a map that is not upright.
      EXPECT_GT((T_odom_world.rotation * Eigen::Vector3d::UnitZ()).z(), std::cos(0.1));
      continue;
    }
    EXPECT_EQ(estimate.state, TrackingState::kTracking) << i;
    const Pose difference = (T_odom_world * T_world_base).inverse() * T_odom_base;
    EXPECT_LT(difference.translation_m.norm(), 0.15) << i;
    EXPECT_LT(so3_log(difference.rotation).norm(), 0.05) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Mounts, Mounting,
                         testing::Values(Pose{}, mount({M_PI, 0, 0}, {0.1, 0.0, 0.5}),
                                         mount({0, 0.5, 0}, {0.3, -0.2, 0.4}),
                                         mount({0.3, -0.5, 2.0}, {0.0, 0.5, 0.0})));

}  // namespace
}  // namespace glint::slam
