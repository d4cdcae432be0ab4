// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// What the exports write, read back byte by byte.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "daemon/export/las_writer.hpp"
#include "daemon/export/pcd_writer.hpp"
#include "daemon/export/pgm_writer.hpp"
#include "daemon/export/ply_writer.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

namespace fs = std::filesystem;

class ExportTest : public testing::Test {
 protected:
  ExportTest() { fs::create_directories(directory_); }
  ~ExportTest() override {
    std::error_code ignored;
    fs::remove_all(directory_, ignored);
  }

  [[nodiscard]] std::string written(const std::string& name) const {
    std::ifstream in(directory_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const fs::path directory_ =
      fs::temp_directory_path() / ("glint-export-" + std::to_string(getpid()));
  const std::vector<slam::MapPoint> points_{
      {1.0F, -2.5F, 0.25F, 0.0F}, {-310.1234F, 20.0F, 3.0F, 255.0F}, {5.0F, 6.0F, 7.0F, 100.0F}};
};

template <class Value>
Value value_at(const std::string& bytes, std::size_t at) {
  Value value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void expect_points_at_end(const std::string& bytes, const std::vector<slam::MapPoint>& points) {
  const std::size_t size = points.size() * sizeof(slam::MapPoint);
  ASSERT_GT(bytes.size(), size);
  EXPECT_EQ(std::memcmp(bytes.data() + bytes.size() - size, points.data(), size), 0);
}

TEST_F(ExportTest, PcdHasAHeaderAndThePointsAsFloats) {
  write_pcd(directory_ / "m.pcd", points_);
  const std::string bytes = written("m.pcd");
  const std::size_t header = bytes.find("DATA binary\n") + 12;
  EXPECT_EQ(bytes.size(), header + points_.size() * 16);
  for (const char* line : {"VERSION 0.7\n", "FIELDS x y z intensity\n", "SIZE 4 4 4 4\n",
                           "TYPE F F F F\n", "WIDTH 3\n", "HEIGHT 1\n", "POINTS 3\n"}) {
    EXPECT_LT(bytes.find(line), header) << line;
  }
  expect_points_at_end(bytes, points_);
}

TEST_F(ExportTest, PlyHasAHeaderAndThePointsAsFloats) {
  write_ply(directory_ / "m.ply", points_);
  const std::string bytes = written("m.ply");
  EXPECT_NE(bytes.find("element vertex 3\n"), std::string::npos);
  EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + points_.size() * 16);
  expect_points_at_end(bytes, points_);
}

// Offsets as the specification's tables have them.
TEST_F(ExportTest, LasHoldsCoordinatesToTheMillimetreAndIntensities) {
  write_las(directory_ / "m.las", points_);
  const std::string bytes = written("m.las");
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(bytes[24], 1);
  EXPECT_EQ(bytes[25], 2);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 94), 227);
  const auto start = value_at<std::uint32_t>(bytes, 96);
  EXPECT_EQ(start, 227U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 100), 0U);
  EXPECT_EQ(bytes[104], 0);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 105), 20);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 107), points_.size());
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 111), points_.size());
  ASSERT_EQ(bytes.size(), start + points_.size() * 20);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::size_t at = start + i * 20;
    const auto coordinate_m = [&](std::size_t axis) {
      return value_at<std::int32_t>(bytes, at + 4 * axis) *
                 value_at<double>(bytes, 131 + 8 * axis) +
             value_at<double>(bytes, 155 + 8 * axis);
    };
    EXPECT_NEAR(coordinate_m(0), points_[i].x_m, 0.00051);
    EXPECT_NEAR(coordinate_m(1), points_[i].y_m, 0.00051);
    EXPECT_NEAR(coordinate_m(2), points_[i].z_m, 0.00051);
    EXPECT_EQ(value_at<std::uint16_t>(bytes, at + 12) / 257.0F, points_[i].intensity);
    EXPECT_EQ(bytes[at + 14], 0x09);
  }
  EXPECT_FLOAT_EQ(static_cast<float>(value_at<double>(bytes, 179)), 5.0F);        // max x
  EXPECT_FLOAT_EQ(static_cast<float>(value_at<double>(bytes, 187)), -310.1234F);  // min x
  EXPECT_DOUBLE_EQ(value_at<double>(bytes, 219), 0.25);                           // min z
}

TEST_F(ExportTest, ALasFileWithoutPointsIsOneToo) {
  write_las(directory_ / "m.las", {});
  EXPECT_EQ(written("m.las").size(), 227U);
}

TEST_F(ExportTest, APlanIsAnImageFromTopToBottomAndItsDescription) {
  slam::FloorPlanImage plan;
  plan.width = 3;
  plan.height = 2;
  plan.cell_m = 0.05;
  plan.origin_m = {-6.4, 12.8};
  using enum slam::FloorCell;
  plan.cells = {kFree, kFree, kUnknown, kOccupied, kUnknown, kFree};
  EXPECT_EQ(write_floor_plan(directory_ / "m.pgm", plan), directory_ / "m.yaml");
  const std::string image = written("m.pgm");
  EXPECT_EQ(image.substr(0, 3), "P5\n");
  EXPECT_NE(image.find("\n3 2\n255\n"), std::string::npos);
  EXPECT_EQ(image.substr(image.size() - 6), std::string("\x00\xCD\xFE\xFE\xFE\xCD", 6));
  EXPECT_EQ(written("m.yaml"),
            "image: m.pgm\nmode: trinary\nresolution: 0.05\norigin: [-6.4, 12.8, 0.0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST_F(ExportTest, AFileThatCannotBeWrittenIsNamed) {
  EXPECT_THROW(write_las(directory_ / "none" / "m.las", points_), InputError);
  EXPECT_THROW(write_floor_plan(directory_ / "m.yaml", {}), InputError);
}

}  // namespace
}  // namespace glint::cli
