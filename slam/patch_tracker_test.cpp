// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/patch_tracker.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>

#include "slam/test_box_room.hpp"
#include "slam/test_painted_tunnel.hpp"

namespace glint::slam {
namespace {

using test::rings;

double lines_along(double /*x_m*/, double angle_rad) {
  return 128.0 + 90.0 * std::sin(3.0 * angle_rad);
}

class PatchTrackerTest : public testing::Test {
 protected:
  void see(const Pose& T_tunnel_sensor, const test::Paint& paint) {
    test::see_tunnel(info_, *lut_, T_tunnel_sensor, paint, images_);
    tracker_.observe(images_, {});
  }
  static Pose pose(double x_m) {
    return {Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())), {x_m, 0.4, -0.5}};
  }
  static WeakAxes along_the_tunnel() {
    WeakAxes axes;
    axes.add({false, Eigen::Vector3d::UnitX(), false});
    return axes;
  }

  const SensorInfo info_ = test::room_sensor();
  const std::shared_ptr<const XyzLut> lut_ = std::make_shared<XyzLut>(info_);
  PatchTracker tracker_{info_, lut_};
  ScanImages images_;
};

TEST_F(PatchTrackerTest, RingsTellTheWayAlongATunnel) {
  see(pose(0.0), rings);
  tracker_.renew(pose(0.0), along_the_tunnel());
  ASSERT_GE(tracker_.size(), 20U);
  for (const double way_m : {0.0, 0.03, 0.21, -0.17}) {
    see(pose(way_m), rings);
    const Pose found = tracker_.search(pose(0.0), along_the_tunnel());
    EXPECT_NEAR(found.translation_m.x(), way_m, 0.02);
    const PatchVotes votes = tracker_.votes(found);
    EXPECT_GE(votes.patches, 12);
    EXPECT_GE(votes.sectors, 3);
    // One step along the axis, all else held.
    const Eigen::Vector3d axis = found.rotation.conjugate() * Eigen::Vector3d::UnitX();
    const double step_m = -votes.term.gradient.head<3>().dot(axis) /
                          axis.dot(votes.term.hessian.topLeftCorner<3, 3>() * axis);
    EXPECT_NEAR(found.translation_m.x() + step_m, way_m, 0.006);
  }
}

TEST_F(PatchTrackerTest, BareWallsAndLinesAlongThemGiveNone) {
  see(pose(0.0), [](double, double) { return 128.0; });
  tracker_.renew(pose(0.0), along_the_tunnel());
  EXPECT_EQ(tracker_.size(), 0U);
  see(pose(0.0), lines_along);
  tracker_.renew(pose(0.0), along_the_tunnel());
  EXPECT_LT(tracker_.size(), 12U);
}

TEST_F(PatchTrackerTest, WhereGeometryHoldsAllAxesThereAreNone) {
  see(pose(0.0), rings);
  tracker_.renew(pose(0.0), along_the_tunnel());
  tracker_.renew(pose(0.0), {});
  EXPECT_EQ(tracker_.size(), 0U);
}

TEST_F(PatchTrackerTest, WhatLooksOtherwiseIsGivenUp) {
  see(pose(0.0), rings);
  tracker_.renew(pose(0.0), along_the_tunnel());
  see(pose(0.0), [](double, double) { return 128.0; });
  EXPECT_EQ(tracker_.votes(pose(0.0)).patches, 0);
  tracker_.renew(pose(0.0), along_the_tunnel());
  EXPECT_EQ(tracker_.size(), 0U);
}

TEST_F(PatchTrackerTest, SparingItTakesNewOnesAtOnceWhereThereAreFew) {
  tracker_.set_sparing(true);
  for (int scan = 0; scan < 4; ++scan) {
    // Each time the rings of before are elsewhere.
    see(pose(scan), rings);
    tracker_.renew(pose(0.0), along_the_tunnel());
    EXPECT_GE(tracker_.size(), 20U) << scan;
  }
}

}  // namespace
}  // namespace glint::slam
