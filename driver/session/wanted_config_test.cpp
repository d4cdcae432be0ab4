// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/wanted_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "driver/core/error.hpp"

namespace glint {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string complaint(const WantedConfig& wanted) {
  try {
    check(wanted);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(WantedConfigTest, OnlyWhatIsSetIsWritten) {
  WantedConfig wanted;
  EXPECT_EQ(to_sensor_json(wanted, {3, 1}), json::object());
  wanted.lidar_mode = "2048x10";
  wanted.udp_port_imu = 0;
  EXPECT_EQ(to_sensor_json(wanted, {3, 1}), json({{"lidar_mode", "2048x10"}, {"udp_port_imu", 0}}));
}

TEST(WantedConfigTest, TheWindowIsInTheFirmwaresUnit) {
  WantedConfig wanted;
  wanted.azimuth_window_mdeg = {{90000, 270000}};
  EXPECT_EQ(to_sensor_json(wanted, {2, 5})["azimuth_window"], json({90000, 270000}));
  EXPECT_EQ(to_sensor_json(wanted, {1, 13})["azimuth_window"], json({9000, 27000}));
}

TEST(WantedConfigTest, AWindowInDegreesIsRefusedWithTheUnit) {
  WantedConfig wanted;
  wanted.azimuth_window_mdeg = {{0, 360}};
  EXPECT_THAT(complaint(wanted), HasSubstr("thousandth of a degree"));
  wanted.azimuth_window_mdeg = {{300000, 500}};  // Wraps.
  EXPECT_EQ(complaint(wanted), "");
  wanted.azimuth_window_mdeg = {{90000, 90000}};
  EXPECT_THAT(complaint(wanted), HasSubstr("empty"));
}

TEST(WantedConfigTest, NamesTheSettingThatIsWrong) {
  WantedConfig wanted;
  wanted.udp_port_lidar = 70000;
  EXPECT_THAT(complaint(wanted), HasSubstr("udp_port_lidar = 70000"));
  wanted = {};
  wanted.timestamp_mode = "PTP";
  EXPECT_THAT(complaint(wanted), HasSubstr("TIME_FROM_PTP_1588"));
}

TEST(WantedConfigTest, NothingCanSmuggleASecondCommandIn) {
  WantedConfig wanted;
  wanted.lidar_mode = "1024x10\nreinitialize";
  EXPECT_THAT(complaint(wanted), HasSubstr("lidar_mode"));
}

}  // namespace
}  // namespace glint
