// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Drives on which surfaces leave the way open.
#include <gtest/gtest.h>

#include <optional>

#include "pcap/synth/simulator.hpp"
#include "slam/frontend.hpp"
#include "slam/test_simulated_walk.hpp"

namespace glint::slam {
namespace {

struct TunnelDrive {
  double path_m = 0.0;
  double error_m = 0.0;
  bool degraded_at_the_end = false;
};

// At 2 m/s through a tunnel with 16 beams, from rest.
TunnelDrive drive_through(const char* world, const SlamConfig& config) {
  synth::SimulationOptions options;
  options.world = world;
  options.seconds = 8.0;
  options.motion.speed_mps = 2.0;
  options.sensor.beams = 16;
  options.sensor.columns = 512;  // Half a scan's work, as sanitizers make it slow.
  synth::Simulator simulator(options);
  Frontend frontend(simulator.info(), config);
  LidarScan scan;
  std::optional<SensorTime> begin;
  SensorTime measured;
  TunnelDrive drive;
  while (test::next_whole(simulator, scan)) {
    if (!begin) {
      begin = scan.end_time;
      measured = scan.column_time.front() + -100'000'000;
    }
    for (const ImuSample& sample : test::measure_motion(simulator, measured, scan.end_time)) {
      frontend.add_imu(sample);
    }
    measured = scan.end_time + 10'000'000;
    const OdometryEstimate& estimate = frontend.process(scan);
    const Pose way = simulator.true_pose(*begin).inverse() * simulator.true_pose(scan.end_time);
    drive.path_m = way.translation_m.norm();
    drive.error_m = (estimate.T_odom_sensor.translation_m - way.translation_m).norm();
    drive.degraded_at_the_end = estimate.state == TrackingState::kDegraded;
  }
  return drive;
}

TEST(FrontendTunnel, JointsTellTheWayWhereGeometryDoesNot) {
  const TunnelDrive drive = drive_through("tunnel", {});
  EXPECT_GT(drive.path_m, 8.0);
  EXPECT_LT(drive.error_m, 0.1);
  EXPECT_FALSE(drive.degraded_at_the_end);
  SlamConfig without;
  without.patches = false;
  EXPECT_GT(drive_through("tunnel", without).error_m, 3.0 * drive.error_m);
}

TEST(FrontendTunnel, BareWallsAreReported) {
  EXPECT_TRUE(drive_through("tunnel-bare", {}).degraded_at_the_end);
}

TEST(FrontendTunnel, PatchesTellTheWayUnderLoad) {
  for (const char* level : {"patches", "keypoints_every_second"}) {
    SlamConfig config;
    config.load_level = level;
    const TunnelDrive drive = drive_through("tunnel", config);
    EXPECT_GT(drive.path_m, 8.0);
    EXPECT_LT(drive.error_m, 0.1) << level;
    EXPECT_FALSE(drive.degraded_at_the_end) << level;
  }
}

}  // namespace
}  // namespace glint::slam
