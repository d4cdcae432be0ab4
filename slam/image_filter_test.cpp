// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/image_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint::slam {
namespace {

constexpr int kRows = 32;
constexpr int kCols = 512;

class ImageFilterTest : public testing::Test {
 protected:
  ImageFilterTest() : intensity_(kRows, kCols), range_mm_(kRows, kCols), brightness_(kRows, kCols) {
    info_.pixels_per_column = kRows;
    info_.columns_per_frame = kCols;
    for (int r = 0; r < kRows; ++r) {
      info_.beam_altitude_deg.push_back(15.5 - r);
      info_.beam_azimuth_deg.push_back(0.0);
      info_.pixel_shift_by_row.push_back(0);
    }
    std::fill(range_mm_.data.begin(), range_mm_.data.end(), 5000U);
  }

  // Fills the intensity; `value` of row and column.
  template <class F>
  void paint(F value) {
    for (int r = 0; r < kRows; ++r) {
      for (int u = 0; u < kCols; ++u) {
        intensity_(r, u) = static_cast<std::uint16_t>(std::lround(value(r, u)));
      }
    }
  }
  void apply(ImageFilter& filter, int times = 1) {
    for (int i = 0; i < times; ++i) filter.apply(intensity_, range_mm_, brightness_);
  }

  // Every other dark and bright block of four columns and rows, at 20 % contrast.
  static double block(int r, int u) { return (r / 4 + u / 4) % 2 == 0 ? 0.8 : 1.2; }
  static double gain(int r) { return r % 4 == 0 ? 1.4 : 1.0; }

  SensorInfo info_;
  Image<std::uint16_t> intensity_;
  Image<std::uint32_t> range_mm_;
  Image<std::uint8_t> brightness_;
};

TEST_F(ImageFilterTest, BeamsThatSeeMoreAreEvenedOut) {
  ImageFilter filter(info_);
  paint([](int r, int) { return 2000 * gain(r); });
  apply(filter);
  int before = 0;
  for (int r = 4; r < kRows - 4; ++r) before = std::max(before, std::abs(brightness_(r, 9) - 128));
  apply(filter, 20);
  int after = 0;
  for (int r = 4; r < kRows - 4; ++r) after = std::max(after, std::abs(brightness_(r, 9) - 128));
  EXPECT_LT(after, 12);
  EXPECT_GE(before, after);
  EXPECT_NEAR(filter.row_factors()[13] / filter.row_factors()[12], 1.4, 0.03);
}

TEST_F(ImageFilterTest, TheScenesOwnGradientIsNotTakenForBeams) {
  ImageFilter filter(info_);
  paint([](int r, int) { return 500 * std::exp(0.08 * r); });
  apply(filter, 20);
  for (const double factor : filter.row_factors()) EXPECT_NEAR(factor, 1.0, 0.01);
}

TEST_F(ImageFilterTest, BeamsAreComparedOnOneSurfaceOnly) {
  ImageFilter filter(info_);
  // The lower half is another surface, ten times as bright and nearer.
  paint([](int r, int) { return r < kRows / 2 ? 200 : 2000; });
  for (int r = kRows / 2; r < kRows; ++r) {
    for (int u = 0; u < kCols; ++u) range_mm_(r, u) = 3000;
  }
  apply(filter, 20);
  for (const double factor : filter.row_factors()) EXPECT_NEAR(factor, 1.0, 1e-6);
}

TEST_F(ImageFilterTest, ContrastIsTheSameInTheDarkAndInTheBright) {
  ImageFilter filter(info_);
  paint([](int r, int u) { return (u < kCols / 2 ? 2000 : 20000) * block(r, u); });
  apply(filter);
  for (int u = 100; u < 140; ++u) {
    EXPECT_NEAR(brightness_(16, u), brightness_(16, u + kCols / 2), 8) << u;
  }
  EXPECT_GT(std::abs(brightness_(16, 110) - brightness_(16, 114)), 50);
}

TEST_F(ImageFilterTest, NoiseOfFewPhotonsStaysBelowWhatCornersNeed) {
  ImageFilter filter(info_);
  std::mt19937 random(1);
  // Twelve even values make a normal one: mean 30, deviation sqrt(30), as of counted photons.
  paint([&](int, int) {
    double sum = 0.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random()) / 4294967296.0;
    return 30.0 + std::sqrt(30.0) * (sum - 6.0);
  });
  apply(filter);
  double squares = 0.0;
  for (const auto value : brightness_.data) squares += (value - 128.0) * (value - 128.0);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(brightness_.data.size())), 10.0);
}

TEST_F(ImageFilterTest, HolesAreNoCornersAndCountForNothing) {
  ImageFilter filter(info_);
  paint([](int, int) { return 1000; });
  for (int r = 10; r < 20; ++r) {
    for (int u = 100; u < 140; ++u) {
      range_mm_(r, u) = 0;
      intensity_(r, u) = 60000;  // means nothing
    }
  }
  apply(filter);
  for (const auto value : brightness_.data) EXPECT_NEAR(value, 128, 1);
}

TEST_F(ImageFilterTest, SeamIsAColumnLikeAnyOther) {
  ImageFilter filter(info_);
  const auto scene = [](int r, int u) { return 1000 * block(r, u) + 3 * std::abs(u - 200); };
  paint([&](int r, int u) { return scene(r, u); });
  apply(filter);
  const auto before = brightness_;
  constexpr int kTurn = 256;
  paint([&](int r, int u) { return scene(r, (u + kTurn) % kCols); });
  ImageFilter turned(info_);
  apply(turned);
  for (int r = 0; r < kRows; ++r) {
    for (int u = 0; u < kCols; ++u) {
      ASSERT_NEAR(brightness_(r, u), before(r, (u + kTurn) % kCols), 1) << r << ' ' << u;
    }
  }
}

TEST_F(ImageFilterTest, AnySensorShapeAndAnEmptyScanAreTaken) {
  for (const int rows : {1, 2, 16, 128}) {
    SensorInfo info = info_;
    info.pixels_per_column = rows;
    info.columns_per_frame = 64;
    info.beam_altitude_deg.assign(static_cast<std::size_t>(rows), 0.0);
    ImageFilter filter(info);
    Image<std::uint8_t> brightness(rows, 64);
    filter.apply(Image<std::uint16_t>(rows, 64), Image<std::uint32_t>(rows, 64), brightness);
    for (const auto value : brightness.data) EXPECT_EQ(value, 128);
  }
}

}  // namespace
}  // namespace glint::slam
