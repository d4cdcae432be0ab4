// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/patch_tracker.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <memory>

#include "slam/test_box_room.hpp"

namespace glint::slam {
namespace {

constexpr double kRadius_m = 3.0;

// Brightness of the wall, by the way along the tunnel and the angle about its axis.
using Paint = std::function<double(double x_m, double angle_rad)>;

// A ring each 3 m: no corner anywhere.
double rings(double x_m, double /*angle_rad*/) {
  const double off_m = std::remainder(x_m, 3.0);
  return 128.0 - 90.0 * std::exp(-off_m * off_m / (2.0 * 0.06 * 0.06));
}
double lines_along(double /*x_m*/, double angle_rad) {
  return 128.0 + 90.0 * std::sin(3.0 * angle_rad);
}

class PatchTrackerTest : public testing::Test {
 protected:
  // In a round tunnel along x.
  void see(const Pose& T_tunnel_sensor, const Paint& paint) {
    images_.range_mm = {info_.pixels_per_column, info_.columns_per_frame};
    images_.brightness = {info_.pixels_per_column, info_.columns_per_frame};
    for (int row = 0; row < info_.pixels_per_column; ++row) {
      const int shift = info_.pixel_shift_by_row[static_cast<std::size_t>(row)];
      for (int m = 0; m < info_.columns_per_frame; ++m) {
        const int u = (m + shift) % info_.columns_per_frame;
        const Eigen::Vector3d ray = T_tunnel_sensor.rotation * lut_->direction(row, m) * 1000.0;
        const Eigen::Vector2d at_m = T_tunnel_sensor.translation_m.tail<2>();
        const Eigen::Vector2d across = ray.tail<2>();
        const double a = across.squaredNorm();
        const double b = at_m.dot(across);
        const double range_m =
            (-b + std::sqrt(b * b + a * (kRadius_m * kRadius_m - at_m.squaredNorm()))) / a;
        const Eigen::Vector3d wall_m = T_tunnel_sensor.translation_m + range_m * ray;
        const bool seen = range_m < 60.0;
        images_.range_mm(row, u) =
            seen ? static_cast<std::uint32_t>(std::lround(1000.0 * range_m)) : 0U;
        images_.brightness(row, u) = static_cast<std::uint8_t>(
            seen ? std::lround(paint(wall_m.x(), std::atan2(wall_m.z(), wall_m.y()))) : 128);
      }
    }
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

}  // namespace
}  // namespace glint::slam
