// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/floor_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glint::slam {
namespace {

constexpr double kHeight_m = 1.0;

/// What a sensor 1 m above the floor of a square room of 8 m sees from `at_m`: walls, floor, and a
/// box of 0.4 m with its middle at (2, 0) unless it was taken away.
std::vector<MapPoint> view(const Eigen::Vector2d& at_m, bool box) {
  std::vector<MapPoint> points;
  for (int beam = -30; beam <= 15; ++beam) {
    for (int column = 0; column < 720; ++column) {
      const double azimuth = (column + 0.5) * M_PI / 360.0;
      const Eigen::Vector3d d(std::cos(azimuth), std::sin(azimuth), std::tan(beam * M_PI / 180.0));
      double range = d.z() < 0.0 ? -kHeight_m / d.z() : 1e9;
      for (int axis = 0; axis < 2; ++axis) {
        range = std::min(range, ((d[axis] > 0 ? 4.0 : -4.0) - at_m[axis]) / d[axis]);
      }
      const Eigen::Vector2d along = Eigen::Vector2d(2.0, 0.0) - at_m;
      const double to_box = along.dot(d.head<2>());
      const double aside = std::abs(along.x() * d.y() - along.y() * d.x());
      const double face = to_box - 0.2;
      if (box && to_box > 0.0 && aside < 0.2 && face * d.z() + kHeight_m < 1.2) {
        range = std::min(range, face);
      }
      const Eigen::Vector3f p = (range * d).cast<float>();
      points.push_back({p.x(), p.y(), p.z(), 50.0F});
    }
  }
  return points;
}

FloorCell cell_at(const FloorPlanImage& image, double x_m, double y_m) {
  const int column = static_cast<int>((x_m - image.origin_m.x()) / image.cell_m);
  const int row = static_cast<int>((y_m - image.origin_m.y()) / image.cell_m);
  if (column < 0 || row < 0 || column >= image.width || row >= image.height) {
    return FloorCell::kUnknown;
  }
  return image.cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(column)];
}

Pose at(const Eigen::Vector2d& p) {
  return {Eigen::Quaterniond::Identity(), {p.x(), p.y(), kHeight_m}};
}

TEST(FloorPlan, ARoomHasWallsAFreeFloorAndNothingBeyond) {
  FloorPlan plan({.cell_m = 0.1});
  for (const double x_m : {-1.0, -0.5, 0.0}) plan.add(at({x_m, 0.3}), view({x_m, 0.3}, true));
  const FloorPlanImage image = plan.image();
  EXPECT_EQ(cell_at(image, -1.53, 1.02), FloorCell::kFree);
  EXPECT_EQ(cell_at(image, 1.0, -2.0), FloorCell::kFree);
  EXPECT_EQ(cell_at(image, 4.03, 2.0), FloorCell::kOccupied);
  EXPECT_EQ(cell_at(image, -1.0, 4.03), FloorCell::kOccupied);
  EXPECT_EQ(cell_at(image, 5.0, 0.0), FloorCell::kUnknown);
  // The box, from its front.
  bool box = false;
  for (double x_m = 1.65; x_m < 2.0; x_m += 0.1) {
    box |= cell_at(image, x_m, 0.05) == FloorCell::kOccupied;
  }
  EXPECT_TRUE(box);
}

TEST(FloorPlan, WhatIsSeenThroughLaterIsFree) {
  FloorPlan plan({.cell_m = 0.1});
  plan.add(at({0, 0}), view({0, 0}, true));
  for (int i = 0; i < 5; ++i) plan.add(at({0, 0}), view({0, 0}, false));
  EXPECT_EQ(cell_at(plan.image(), 1.82, 0.02), FloorCell::kFree);
}

TEST(FloorPlan, WhatIsNoPlaceIsLeftOut) {
  FloorPlan plan({});
  plan.add({}, {{std::nanf(""), 0, 0, 1}, {INFINITY, 0, 0, 1}, {0, -INFINITY, 0, 1}});
  EXPECT_TRUE(plan.image().cells.empty());
}

TEST(FloorPlan, NothingSeenIsAnEmptyPlan) { EXPECT_TRUE(FloorPlan({}).image().cells.empty()); }

}  // namespace
}  // namespace glint::slam
