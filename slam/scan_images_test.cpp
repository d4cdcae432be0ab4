// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/scan_images.hpp"

#include <gtest/gtest.h>

namespace glint::slam {
namespace {

class ImageFormerTest : public testing::Test {
 protected:
  ImageFormerTest() {
    info_.profile = LidarProfile::kLegacy;
    info_.pixels_per_column = 2;
    info_.columns_per_frame = 32;
    info_.columns_per_packet = 16;
    info_.column_window = {0, 31};
    info_.pixel_shift_by_row = {0, 3};
    info_.beam_altitude_deg = {1.0, -1.0};
    info_.beam_azimuth_deg = {0.0, 0.0};
    scan_ = LidarScan(PacketFormat(info_));
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 32; ++c) {
        scan_.range_mm(r, c) = 5000;
        scan_.signal(r, c) = static_cast<std::uint16_t>(100 * (c + 1));
        scan_.near_ir(r, c) = static_cast<std::uint16_t>(c);
      }
    }
  }

  SensorInfo info_;
  SlamConfig config_;
  LidarScan scan_;
  ScanImages images_;
};

TEST_F(ImageFormerTest, ImagesAreDestaggered) {
  ImageFormer(info_, config_).form(scan_, images_);
  EXPECT_EQ(images_.intensity(0, 5), 600);
  EXPECT_EQ(images_.intensity(1, 5), 300);  // measured three columns earlier
  EXPECT_EQ(images_.near_ir(1, 0), 29);     // and round the seam
}

TEST_F(ImageFormerTest, IntensityIsSpreadOverEightBits) {
  ImageFormer(info_, config_).form(scan_, images_);
  EXPECT_LE(images_.intensity_u8(0, 0), 10);
  EXPECT_GE(images_.intensity_u8(0, 31), 250);
  EXPECT_GT(images_.intensity_u8(0, 20), images_.intensity_u8(0, 10));
}

TEST_F(ImageFormerTest, ScaleDoesNotDependOnTheSensorsUnits) {
  ImageFormer(info_, config_).form(scan_, images_);
  const auto before = images_.intensity_u8;
  for (auto& value : scan_.signal.data) value = static_cast<std::uint16_t>(value * 20);
  ImageFormer(info_, config_).form(scan_, images_);
  for (std::size_t i = 0; i < before.data.size(); ++i) {
    EXPECT_NEAR(before.data[i], images_.intensity_u8.data[i], 1);
  }
}

TEST_F(ImageFormerTest, NoReturnAndTheRobotItselfAreBlack) {
  scan_.range_mm(0, 7) = 0;
  scan_.range_mm(0, 8) = 200;  // nearer than min_range_m
  ImageFormer(info_, config_).form(scan_, images_);
  EXPECT_EQ(images_.intensity_u8(0, 7), 0);
  EXPECT_EQ(images_.intensity_u8(0, 8), 0);
  EXPECT_EQ(images_.range_mm(0, 8), 0U);
  EXPECT_GT(images_.intensity_u8(0, 9), 0);
}

TEST_F(ImageFormerTest, FeaturesSeeTheFilteredImageOrWhatWasMeasured) {
  config_.image_filter = false;
  ImageFormer(info_, config_).form(scan_, images_);
  EXPECT_EQ(images_.brightness.data, images_.intensity_u8.data);
  const auto measured = images_.intensity_u8;
  config_.image_filter = true;
  ImageFormer(info_, config_).form(scan_, images_);
  EXPECT_EQ(images_.intensity_u8.data, measured.data);
  EXPECT_NE(images_.brightness.data, measured.data);
  scan_.range_mm(0, 7) = 0;
  ImageFormer(info_, config_).form(scan_, images_);
  EXPECT_EQ(images_.brightness(0, 7), 128);
}

TEST_F(ImageFormerTest, ReflectivityStandsInWhereThereIsNoSignal) {
  info_.profile = LidarProfile::kRng15Rfl8Nir8;
  LidarScan scan{PacketFormat(info_)};
  for (auto& range_mm : scan.range_mm.data) range_mm = 4000;
  scan.reflectivity(0, 4) = 200;
  ImageFormer(info_, config_).form(scan, images_);
  EXPECT_EQ(images_.intensity(0, 4), 200);
}

}  // namespace
}  // namespace glint::slam
