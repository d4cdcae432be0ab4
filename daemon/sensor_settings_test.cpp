// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/sensor_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensor_change.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::daemon {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// What would be written to a sensor of today.
json wanted(const Config::Sensor& sensor) {
  return to_sensor_json(sensor_link_options(sensor, {7600, 7601}).session.wanted.value(), {3, 1});
}

std::string error_of(const Config::Sensor& sensor) {
  try {
    sensor_link_options(sensor, {});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

Config::Sensor with_host() {
  Config::Sensor sensor;
  sensor.host = "os-122201000998.local";
  return sensor;
}

TEST(SensorSettings, ByDefaultTheSensorIsOnlyToldToSendHere) {
  EXPECT_EQ(wanted(with_host()),
            (json{{"udp_dest", "@auto"}, {"udp_port_lidar", 7600}, {"udp_port_imu", 7601}}));
  EXPECT_FALSE(sensor_link_options(with_host(), {}).session.persist);
}

TEST(SensorSettings, PacketsGoToTheAddressThatIsListenedOn) {
  Config::Sensor sensor = with_host();
  sensor.bind_address = "192.0.2.7";
  EXPECT_EQ(wanted(sensor)["udp_dest"], "192.0.2.7");
  sensor.multicast_group = "ff02::1234%eth0";
  EXPECT_EQ(wanted(sensor)["udp_dest"], "ff02::1234");
  sensor.udp_dest = "239.201.201.1";
  EXPECT_EQ(wanted(sensor)["udp_dest"], "239.201.201.1");
  sensor.udp_dest = "";
  EXPECT_FALSE(wanted(sensor).contains("udp_dest"));
}

TEST(SensorSettings, EveryKeyReachesTheSensor) {
  Config::Sensor sensor = with_host();
  sensor.lidar_mode = "2048x10";
  sensor.timestamp_mode = "TIME_FROM_PTP_1588";
  sensor.operating_mode = "NORMAL";
  sensor.udp_profile_lidar = "RNG15_RFL8_NIR8";
  sensor.udp_profile_imu = "LEGACY";
  sensor.azimuth_window_mdeg = {300'000, 60'000};
  sensor.signal_multiplier = 0.5;
  const json settings = wanted(sensor);
  EXPECT_EQ(settings["lidar_mode"], "2048x10");
  EXPECT_EQ(settings["timestamp_mode"], "TIME_FROM_PTP_1588");
  EXPECT_EQ(settings["operating_mode"], "NORMAL");
  EXPECT_EQ(settings["udp_profile_lidar"], "RNG15_RFL8_NIR8");
  EXPECT_EQ(settings["udp_profile_imu"], "LEGACY");
  EXPECT_EQ(settings["azimuth_window"], (json{300'000, 60'000}));
  EXPECT_EQ(settings["signal_multiplier"], 0.5);
}

TEST(SensorSettings, ASensorThatIsNotToBeConfiguredGetsNothing) {
  Config::Sensor sensor = with_host();
  sensor.configure = false;
  sensor.lidar_mode = "2048x10";
  EXPECT_FALSE(sensor_link_options(sensor, {}).session.wanted.has_value());
  EXPECT_THAT(idle_settings(sensor), AllOf(HasSubstr("lidar_mode"), HasSubstr("configure")));
  sensor.host.clear();
  EXPECT_THAT(idle_settings(sensor), HasSubstr("sensor.host is not set"));
  EXPECT_EQ(idle_settings(Config::Sensor{}), "");
}

TEST(SensorSettings, WhatNoSensorTakesIsAConfigurationError) {
  Config::Sensor sensor = with_host();
  sensor.azimuth_window_mdeg = {0, 360};
  EXPECT_THAT(error_of(sensor), AllOf(HasSubstr("azimuth_window"), HasSubstr("[0, 360000]")));
  sensor = with_host();
  sensor.timestamp_mode = "PTP";
  EXPECT_THAT(error_of(sensor), HasSubstr("TIME_FROM_PTP_1588"));
  sensor = with_host();
  sensor.host = "a sensor";
  EXPECT_NE(error_of(sensor), "");
}

TEST(SensorSettings, TheSourceIsFilteredUnlessTheUserSaysElse) {
  Config::Sensor sensor = with_host();
  EXPECT_TRUE(sensor_link_options(sensor, {}).filter_source);
  sensor.source_address = "any";
  EXPECT_FALSE(sensor_link_options(sensor, {}).filter_source);
  EXPECT_EQ(source_filter(sensor), "");
  sensor.source_address = "192.0.2.9";
  EXPECT_FALSE(sensor_link_options(sensor, {}).filter_source);
  EXPECT_EQ(source_filter(sensor), "192.0.2.9");
}

TEST(StreamChange, WhoseMetadataTheyAreIsNoChange) {
  const SensorInfo info = test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 64, 512);
  SensorInfo other = info;
  other.serial_number = "1";
  other.init_id = 2;
  other.firmware = "v9.9.9";
  other.lidar_port = 9;
  EXPECT_EQ(stream_change(info, other), "");
}

TEST(StreamChange, EachThingThatShapesScansIsOne) {
  const SensorInfo info = test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 64, 512);
  const auto changed = [&](auto change) {
    SensorInfo other = info;
    change(other);
    return stream_change(info, other);
  };
  EXPECT_EQ(changed([](SensorInfo& s) { s.profile = LidarProfile::kLegacy; }),
            "profile RNG19_RFL8_SIG16_NIR16 -> LEGACY");
  EXPECT_EQ(changed([](SensorInfo& s) { s.columns_per_frame = 1024; }),
            "columns a frame 512 -> 1024");
  EXPECT_EQ(changed([](SensorInfo& s) { s.columns_per_packet = 8; }), "columns a packet 16 -> 8");
  EXPECT_EQ(changed([](SensorInfo& s) { s.pixels_per_column = 32; }), "beams 64 -> 32");
  EXPECT_EQ(changed([](SensorInfo& s) { s.scan_rate_hz = 20; }), "scans a second 10 -> 20");
  EXPECT_EQ(changed([](SensorInfo& s) {
              s.column_window = {1, 256};
            }),
            "column window [0, 511] -> [1, 256]");
  EXPECT_NE(changed([](SensorInfo& s) { s.header = PacketHeader::kFusa; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.imu_profile = ImuProfile::kAccel32Gyro32Nmea; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.pixel_shift_by_row[0] += 1; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.beam_altitude_deg[3] += 0.1; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.beam_azimuth_deg[3] += 0.1; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.beam_to_lidar(0, 3) += 1; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.lidar_to_sensor(2, 3) += 1; }), "");
  EXPECT_NE(changed([](SensorInfo& s) { s.imu_to_sensor(2, 3) += 1; }), "");
}

}  // namespace
}  // namespace glint::daemon
