// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/xyz_lut.hpp"

#include <gtest/gtest.h>

#include "driver/core/destagger.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

// One level beam without any offsets of its own, so that points can be told by hand.
SensorInfo plain_sensor() {
  SensorInfo info = test::make_sensor(LidarProfile::kLegacy, 1, 1024);
  info.beam_altitude_deg = {0.0};
  info.beam_azimuth_deg = {0.0};
  return info;
}

TEST(XyzLut, ColumnZeroLooksAtTheConnectorAndColumnsTurnClockwise) {
  const XyzLut lut(plain_sensor());
  // Seen in the sensor frame, whose x points away from the connector.
  EXPECT_TRUE(lut.point(0, 0, 10'000).isApprox(Eigen::Vector3d(-10.0, 0.0, 0.03618), 1e-9));
  EXPECT_TRUE(lut.point(0, 256, 10'000).isApprox(Eigen::Vector3d(0.0, 10.0, 0.03618), 1e-9));
  EXPECT_TRUE(lut.point(0, 512, 10'000).isApprox(Eigen::Vector3d(10.0, 0.0, 0.03618), 1e-9));
}

TEST(XyzLut, BeamsLeaveFromTheirOriginNotFromTheAxis) {
  SensorInfo info = plain_sensor();
  info.beam_altitude_deg = {30.0};
  const XyzLut lut(info);
  // Range counts from the axis by way of the beam's origin, 15.806 mm out.
  const double along_m = (10'000 - 15.806) * 1e-3;
  const Eigen::Vector3d expected(along_m * std::cos(M_PI / 6) + 0.015806, 0.0,
                                 along_m * 0.5 + 0.03618);
  EXPECT_TRUE(lut.point(0, 512, 10'000).isApprox(expected, 1e-9));
}

TEST(XyzLut, PositiveBeamAzimuthTurnsClockwise) {
  SensorInfo info = plain_sensor();
  info.beam_azimuth_deg = {90.0};
  info.beam_to_lidar.setIdentity();
  EXPECT_TRUE(XyzLut(info).point(0, 0, 1'000).isApprox(Eigen::Vector3d(0.0, 1.0, 0.03618), 1e-9));
}

TEST(XyzLut, NoReturnGivesNoPoint) {
  EXPECT_TRUE(XyzLut(plain_sensor()).point(0, 7, 0).isZero(0.0));
}

TEST(XyzLut, PointsOfAScanAreThoseOfItsPixelsDestaggered) {
  SensorInfo info = test::make_sensor(LidarProfile::kLegacy, 6, 128);
  info.pixel_shift_by_row = {0, 5, -7, 127, 130, -300};
  const XyzLut lut(info);
  std::mt19937 random(4);
  LidarScan scan = test::random_scan(info, 0, random);
  for (std::size_t i = 0; i < scan.range_mm.data.size(); i += 3) scan.range_mm.data[i] = 0;

  std::vector<Eigen::Vector3d> points(scan.range_mm.data.size(), Eigen::Vector3d::Constant(7.0));
  lut.destaggered_points(scan.range_mm, info.pixel_shift_by_row, points);

  Image<double> staggered_x(6, 128);
  Image<double> x(6, 128);
  for (int r = 0; r < 6; ++r) {
    for (int m = 0; m < 128; ++m) staggered_x(r, m) = lut.point(r, m, scan.range_mm(r, m)).x();
  }
  destagger(staggered_x, info.pixel_shift_by_row, x);
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 128; ++c) {
      const Eigen::Vector3d& point = points[x.index(r, c)];
      const int m = staggered_column(c, info.pixel_shift_by_row[static_cast<std::size_t>(r)], 128);
      EXPECT_EQ(point, lut.point(r, m, scan.range_mm(r, m))) << r << ", " << c;
      EXPECT_EQ(point.x(), x(r, c));
    }
  }
}

TEST(Destagger, RowsAreRotatedByTheirShift) {
  Image<std::uint16_t> in(3, 4);
  for (std::size_t i = 0; i < in.data.size(); ++i) in.data[i] = static_cast<std::uint16_t>(i);
  Image<std::uint16_t> out(3, 4);
  destagger(in, std::vector{0, 1, -1}, out);
  EXPECT_EQ(out.data, (std::vector<std::uint16_t>{0, 1, 2, 3, 7, 4, 5, 6, 9, 10, 11, 8}));
  EXPECT_EQ(out(1, 0), in(1, staggered_column(0, 1, 4)));
  EXPECT_EQ(out(2, 3), in(2, staggered_column(3, -1, 4)));
}

TEST(Destagger, ShiftsBeyondARevolutionWrap) {
  EXPECT_EQ(staggered_column(0, 5, 4), 3);
  EXPECT_EQ(staggered_column(3, -6, 4), 1);
}

}  // namespace
}  // namespace glint
