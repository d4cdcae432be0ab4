// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/image_projection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "driver/core/xyz_lut.hpp"
#include "slam/test_box_room.hpp"

namespace glint::slam {
namespace {

// Beams that start off the axis, in a frame that looks the other way.
SensorInfo real_sensor() {
  SensorInfo info = test::room_sensor();
  info.beam_to_lidar(0, 3) = 15.806;
  info.lidar_to_sensor.diagonal() << -1.0, -1.0, 1.0, 1.0;
  info.lidar_to_sensor(2, 3) = 36.18;
  return info;
}

int destaggered(const SensorInfo& info, int row, int column) {
  return (column + info.pixel_shift_by_row[static_cast<std::size_t>(row)]) % info.columns_per_frame;
}

TEST(ImageProjection, FindsThePixelThatMeasuredAPoint) {
  const SensorInfo info = real_sensor();
  const XyzLut lut(info);
  const ImageProjection projection(info);
  for (int row = 1; row < info.pixels_per_column - 1; ++row) {
    for (int column = 0; column < info.columns_per_frame; column += 7) {
      for (const std::uint32_t range_mm : {1'500U, 40'000U}) {
        const Eigen::Vector3d point_m = lut.point(row, column, range_mm);
        ImageProjection::Place place;
        ASSERT_TRUE(projection.project(point_m, place));
        EXPECT_NEAR(place.row + place.share_below, row, 0.02);
        EXPECT_EQ(projection.column_at(place), column) << row;
        EXPECT_NEAR(projection.range_of_m(point_m), 0.001 * range_mm, 0.02);
        Image<std::uint32_t> ranges(info.pixels_per_column, info.columns_per_frame);
        ranges(row, destaggered(info, row, column)) = range_mm;
        EXPECT_DOUBLE_EQ(projection.range_near_m(ranges, point_m), 0.001 * range_mm);
      }
    }
  }
}

TEST(ImageProjection, WhatNoRowLooksAtIsNotInTheImage) {
  const ImageProjection projection(real_sensor());
  ImageProjection::Place place;
  ImageProjection::Sample sample;
  const Image<std::uint8_t> image(32, real_sensor().columns_per_frame);
  for (const double z_m : {10.0, -10.0, std::nan("")}) {
    EXPECT_FALSE(projection.project({1.0, 0.5, z_m}, place)) << z_m;
    EXPECT_FALSE(projection.sample(image, {1.0, 0.5, z_m}, sample)) << z_m;
  }
}

TEST(ImageProjection, SamplesBetweenPixelsAndKnowsTheSlope) {
  const SensorInfo info = real_sensor();
  const XyzLut lut(info);
  const ImageProjection projection(info);
  Image<std::uint8_t> image(info.pixels_per_column, info.columns_per_frame);
  for (int row = 0; row < image.rows; ++row) {
    for (int u = 0; u < image.cols; ++u) {
      image(row, u) = static_cast<std::uint8_t>(
          std::lround(128.0 + 60.0 * std::sin(0.05 * u) + 2.0 * row - 30.0));
    }
  }
  const Eigen::Vector3d point_m = lut.point(14, 200, 5'000);
  ImageProjection::Sample sample;
  ASSERT_TRUE(projection.sample(image, point_m, sample));
  EXPECT_NEAR(sample.value, image(14, destaggered(info, 14, 200)), 1.5);
  // Between two rows, as the slope has a step at each.
  const Eigen::Vector3d between_m = 0.5 * (point_m + lut.point(13, 200, 5'000));
  ASSERT_TRUE(projection.sample(image, between_m, sample));
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step_m = 0.05 * Eigen::Vector3d::Unit(axis);
    ImageProjection::Sample before;
    ImageProjection::Sample after;
    ASSERT_TRUE(projection.sample(image, between_m - step_m, before));
    ASSERT_TRUE(projection.sample(image, between_m + step_m, after));
    EXPECT_NEAR(sample.gradient(axis), (after.value - before.value) / 0.1F, 6.0F) << axis;
  }
  const Eigen::Vector3d last_m = lut.point(14, 206, 5'000);
  std::array<float, 7> values{};
  ASSERT_TRUE(projection.values_between(image, point_m, last_m, values));
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(values[static_cast<std::size_t>(i)], image(14, destaggered(info, 14, 200 + i)),
                1.5);
  }
}

}  // namespace
}  // namespace glint::slam
