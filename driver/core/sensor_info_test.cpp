// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/sensor_info.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

std::filesystem::path data_folder() {
  const char* named = std::getenv("GLINT_DATA_DIR");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data";
}

// Files of real sensors; a missing folder skips the test, but not on the build server.
std::vector<std::filesystem::path> metadata_files(const char* folder) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / folder, none)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  const char* ci = std::getenv("CI");
  if (files.empty() && ci != nullptr && std::string_view(ci) == "true") {
    ADD_FAILURE() << "no metadata in " << data_folder() / folder << "; set GLINT_DATA_DIR";
  }
  return files;
}

json flat_metadata() {
  return {{"prod_line", "OS-1-64"},
          {"lidar_mode", "1024x10"},
          {"beam_altitude_angles", {10.0, 0.0}},
          {"beam_azimuth_angles", {3.0, -3.0}},
          {"data_format",
           {{"columns_per_frame", 1024},
            {"columns_per_packet", 16},
            {"pixels_per_column", 2},
            {"pixel_shift_by_row", {9, -9}},
            {"column_window", {1000, 20}},
            {"udp_profile_lidar", "RNG15_RFL8_NIR8"}}}};
}

SensorInfo parse(const json& metadata) { return parse_sensor_info(metadata.dump(), "test.json"); }

// Expects a refusal that names the metadata, the key and more.
void expect_refused(const json& metadata, const std::string& why) {
  EXPECT_THAT([&] { parse(metadata); },
              ThrowsMessage<MetadataError>(AllOf(HasSubstr("metadata test.json"), HasSubstr(why))));
}

TEST(SensorInfo, FlatFormIsRead) {
  const SensorInfo info = parse(flat_metadata());
  EXPECT_EQ(info.profile, LidarProfile::kRng15Rfl8Nir8);
  EXPECT_EQ(info.columns_per_frame, 1024);
  EXPECT_EQ(info.pixels_per_column, 2);
  EXPECT_EQ(info.column_window, (std::pair{1000, 20}));
  EXPECT_EQ(info.pixel_shift_by_row, (std::vector{9, -9}));
  EXPECT_DOUBLE_EQ(info.scan_rate_hz, 10.0);
  EXPECT_THAT(info.warnings, IsEmpty());
}

TEST(SensorInfo, BarestMetadataIsAFirstGenerationLegacySensor) {
  json metadata{{"lidar_mode", "512x20"}};
  for (int r = 0; r < 64; ++r) {
    metadata["beam_altitude_angles"].push_back(16.0 - r * 0.5);
    metadata["beam_azimuth_angles"].push_back(3.0 - 2.0 * (r % 4));
  }
  const SensorInfo info = parse(metadata);
  EXPECT_EQ(info.profile, LidarProfile::kLegacy);
  EXPECT_EQ(info.columns_per_frame, 512);
  EXPECT_EQ(info.columns_per_packet, 16);
  EXPECT_EQ(info.column_window, (std::pair{0, 511}));
  EXPECT_DOUBLE_EQ(info.scan_rate_hz, 20.0);
  EXPECT_EQ(std::vector(info.pixel_shift_by_row.begin(), info.pixel_shift_by_row.begin() + 5),
            (std::vector{9, 6, 3, 0, 9}));
  EXPECT_DOUBLE_EQ(info.beam_to_lidar(0, 3), 12.163);
  EXPECT_DOUBLE_EQ(info.lidar_to_sensor(2, 3), 36.18);
  EXPECT_DOUBLE_EQ(info.lidar_to_sensor(0, 0), -1.0);
  EXPECT_DOUBLE_EQ(info.imu_to_sensor(1, 3), -11.775);
  EXPECT_EQ(info.lidar_port, 7502);
  EXPECT_THAT(info.warnings, SizeIs(1));
}

TEST(SensorInfo, GroupsThatAreErrorSentencesCountAsAbsent) {
  json metadata;
  metadata["sensor_info"] = {{"prod_line", "OS-1-64"}, {"build_rev", "v1.13.0"}};
  metadata["beam_intrinsics"] = {{"beam_altitude_angles", {1.0, -1.0}},
                                 {"beam_azimuth_angles", {0.0, 0.0}}};
  metadata["config_params"] = {{"lidar_mode", "2048x10"}, {"udp_port_lidar", 60823}};
  metadata["lidar_data_format"] = "error: Command not recognized.";
  metadata["lidar_intrinsics"] = "error: Command not recognized.";
  const SensorInfo info = parse(metadata);
  EXPECT_EQ(info.columns_per_frame, 2048);
  EXPECT_EQ(info.lidar_port, 60823);
  EXPECT_DOUBLE_EQ(info.lidar_to_sensor(2, 3), 36.18);
}

TEST(SensorInfo, ColumnsThatContradictTheModeOnlyWarn) {
  json metadata = flat_metadata();
  metadata["lidar_mode"] = "2048x10";
  const SensorInfo info = parse(metadata);
  EXPECT_EQ(info.columns_per_frame, 1024);
  EXPECT_THAT(info.warnings, ElementsAre(HasSubstr("2048x10")));
}

TEST(SensorInfo, AzimuthWindowInWholeDegreesIsWarnedOf) {
  json metadata = flat_metadata();
  metadata["azimuth_window"] = {0, 360};
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("azimuth window")));
}

TEST(SensorInfo, TheClockIsThatOfTheTimestampModeAndTheOscillatorWithoutOne) {
  json metadata = flat_metadata();
  EXPECT_EQ(parse(metadata).clock, ClockSource::kInternal);
  metadata["timestamp_mode"] = "TIME_FROM_PTP_1588";
  EXPECT_EQ(parse(metadata).clock, ClockSource::kPtp);
  metadata["timestamp_mode"] = "TIME_FROM_SYNC_PULSE_IN";
  EXPECT_EQ(parse(metadata).clock, ClockSource::kPps);
  EXPECT_EQ(to_string(parse(metadata).clock), "pps");
  metadata["timestamp_mode"] = "TIME_FROM_THE_STARS";
  EXPECT_EQ(parse(metadata).clock, ClockSource::kInternal);
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("TIME_FROM_THE_STARS")));
}

TEST(SensorInfo, ImuProfileThatIsNotReadIsWarnedOf) {
  json metadata = flat_metadata();
  metadata["data_format"]["udp_profile_imu"] = "ACCEL99_NEW";
  const SensorInfo info = parse(metadata);
  EXPECT_THAT(info.warnings, ElementsAre(HasSubstr("ACCEL99_NEW")));
  EXPECT_EQ(info.imu_profile, ImuProfile::kLegacy);
}

TEST(SensorInfo, ImuProfileIsReadFromTheDataFormatOrTheConfiguration) {
  json metadata = flat_metadata();
  EXPECT_EQ(parse(metadata).imu_profile, ImuProfile::kLegacy);
  metadata["udp_profile_imu"] = "ACCEL32_GYRO32_NMEA";
  SensorInfo info = parse(metadata);
  EXPECT_EQ(info.imu_profile, ImuProfile::kAccel32Gyro32Nmea);
  EXPECT_EQ(info.imu_measurements_per_packet, 8);
  EXPECT_THAT(info.warnings, IsEmpty());

  metadata["data_format"]["udp_profile_imu"] = "ACCEL32_GYRO32_NMEA";
  metadata["imu_data_format"] = {{"imu_measurements_per_packet", 16}, {"imu_packets_per_frame", 4}};
  info = parse(metadata);
  EXPECT_EQ(info.imu_measurements_per_packet, 16);
  EXPECT_EQ(info.imu_packets_per_frame, 4);

  metadata["imu_data_format"]["imu_packets_per_frame"] = 0;
  expect_refused(metadata, "imu_data_format.imu_packets_per_frame must be");
}

TEST(SensorInfo, UnknownProfileIsNamedWithTheKnownOnes) {
  json metadata = flat_metadata();
  metadata["data_format"]["udp_profile_lidar"] = "RNG99_NEW";
  expect_refused(metadata, "udp_profile_lidar is RNG99_NEW");
  expect_refused(metadata, "RNG19_RFL8_SIG16_NIR16_DUAL, RNG15_RFL8_NIR8");
}

TEST(SensorInfo, WrongValuesAreRefusedByName) {
  const auto with = [](const char* key, const json& value) {
    json metadata = flat_metadata();
    metadata["data_format"][key] = value;
    return metadata;
  };
  expect_refused(with("columns_per_packet", 0), "data_format.columns_per_packet must be");
  expect_refused(with("columns_per_packet", 15), "does not divide");
  expect_refused(with("columns_per_frame", 1 << 30), "data_format.columns_per_frame must be");
  expect_refused(with("columns_per_frame", "1024"), "data_format.columns_per_frame must be");
  expect_refused(with("columns_per_frame", 1024.5), "data_format.columns_per_frame must be");
  expect_refused(with("pixels_per_column", 64), "64 but there are 2 beam angles");
  expect_refused(with("pixel_shift_by_row", {1, 2, 3}), "3 entries but there are 2 beams");
  expect_refused(with("column_window", {0, 1024}), "data_format.column_window must hold");
  expect_refused(with("column_window", {0}), "two columns");
}

TEST(SensorInfo, TransformsThatAreNoMotionsAreRefused) {
  json metadata = flat_metadata();
  metadata["lidar_to_sensor_transform"] = {1, 0, 0};
  expect_refused(metadata, "lidar_to_sensor_transform must hold 16 numbers");
  metadata["lidar_to_sensor_transform"] = std::vector<double>(16, 0.0);
  expect_refused(metadata, "no rigid motion");
}

TEST(SensorInfo, KeysThatComeTwiceAreRefused) {
  EXPECT_THAT([] { parse_sensor_info(R"({"lidar_mode":"1024x10","lidar_mode":"512x10"})", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("lidar_mode comes twice")));
  EXPECT_THAT([] { parse_sensor_info(R"({"data_format":{"a":1,"a":1}})", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("a comes twice")));
}

TEST(SensorInfo, WhatIsNoMetadataIsRefused) {
  EXPECT_THAT([] { parse_sensor_info("", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("not JSON")));
  EXPECT_THAT([] { parse_sensor_info("[]", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("not a JSON object")));
  EXPECT_THAT([] { parse_sensor_info(R"({"a":1e999})", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("metadata m")));
  EXPECT_THAT([] { parse_sensor_info("{\"a\":\"\xFF\"}", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("not JSON")));
  EXPECT_THAT([] { parse_sensor_info(std::string(100'000, '['), "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("nested deeper")));
  EXPECT_THAT([] { parse_sensor_info(std::string(2 << 20, ' '), "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("larger than")));
  EXPECT_THAT(
      [] { load_sensor_info("/no/such/file.json"); },
      ThrowsMessage<MetadataError>(HasSubstr("/no/such/file.json: the file cannot be read")));
}

TEST(SensorInfo, WrittenMetadataReadsBackEqual) {
  for (const auto profile : {LidarProfile::kLegacy, LidarProfile::kRng19Rfl8Sig16Nir16Dual}) {
    SensorInfo info = test::make_sensor(profile, 32, 512);
    info.column_window = {500, 11};
    info.lidar_port = 17502;
    if (profile != LidarProfile::kLegacy) info.imu_profile = ImuProfile::kAccel32Gyro32Nmea;
    info.imu_packets_per_frame = profile == LidarProfile::kLegacy ? 8 : 4;
    info.beam_altitude_deg[3] = 1.0 / 3.0;
    const SensorInfo read = parse_sensor_info(to_metadata_json(info), "m");
    EXPECT_EQ(to_metadata_json(read), to_metadata_json(info));
    EXPECT_EQ(read.beam_altitude_deg, info.beam_altitude_deg);
    EXPECT_EQ(read.column_window, info.column_window);
    EXPECT_EQ(read.init_id, info.init_id);
    EXPECT_EQ(read.lidar_to_sensor, info.lidar_to_sensor);
    EXPECT_EQ(read.beam_to_lidar, info.beam_to_lidar);
    EXPECT_EQ(read.lidar_port, 17502);
    EXPECT_EQ(read.imu_profile, info.imu_profile);
    EXPECT_EQ(read.imu_measurements_per_packet, info.imu_measurements_per_packet);
    EXPECT_EQ(read.imu_packets_per_frame, info.imu_packets_per_frame);
  }
}

TEST(SensorInfo, MetadataOfEveryFirmwareIsRead) {
  int count = 0;
  for (const char* folder : {"metadata", "ouster"}) {
    for (const auto& file : metadata_files(folder)) {
      EXPECT_NO_THROW(load_sensor_info(file)) << file;
      ++count;
    }
  }
  if (count == 0) GTEST_SKIP() << "no metadata below " << data_folder() << "; set GLINT_DATA_DIR";
}

TEST(SensorInfo, MalformedMetadataIsRefusedEachForItsOwnReason) {
  const auto files = metadata_files("malformed");
  if (files.empty())
    GTEST_SKIP() << "no metadata below " << data_folder() << "; set GLINT_DATA_DIR";
  std::set<std::string> reasons;
  for (const auto& file : files) {
    try {
      load_sensor_info(file);
      ADD_FAILURE() << file << " was taken";
    } catch (const MetadataError& error) {
      const std::string message = error.what();
      reasons.insert(message.substr(message.find(".json: ")));
    }
  }
  EXPECT_EQ(reasons.size(), files.size());
}

}  // namespace
}  // namespace glint
