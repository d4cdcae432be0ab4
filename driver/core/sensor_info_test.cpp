// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/sensor_info.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "driver/core/profile_names.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

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

TEST(SensorInfo, AzimuthWindowInWholeDegreesIsWarnedOfInItsUnit) {
  json metadata = flat_metadata();
  metadata["azimuth_window"] = {0, 360};
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("0.36 degrees wide")));
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("0 to 360000")));
  metadata["azimuth_window"] = {359'900, 100};
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("0.2 degrees wide")));
  metadata["azimuth_window"] = {359'000, 1000};
  EXPECT_THAT(parse(metadata).warnings, IsEmpty());
  metadata["build_rev"] = "v1.14.0";
  metadata["azimuth_window"] = {0, 36};
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("0.36 degrees wide")));
  EXPECT_THAT(parse(metadata).warnings, ElementsAre(HasSubstr("0 to 36000")));
  metadata["azimuth_window"] = {0, 360};  // 3.6 degrees.
  EXPECT_THAT(parse(metadata).warnings, IsEmpty());
  metadata["azimuth_window"] = {0, 400'000};
  expect_refused(metadata, "azimuth_window must hold whole numbers from 0 to 360000");
  metadata["azimuth_window"] = {0};
  expect_refused(metadata, "azimuth_window must hold two angles");
}

// Pairs that sensors of firmware 2 and later told, column window beside azimuth window.
TEST(SensorInfo, ColumnWindowFollowsFromTheAzimuthWindowWhereItIsMissing) {
  json metadata = flat_metadata();
  metadata["lidar_mode"] = "512x10";
  metadata["data_format"]["columns_per_frame"] = 512;
  metadata["data_format"].erase("column_window");
  EXPECT_EQ(parse(metadata).column_window, (std::pair{0, 511}));
  metadata["azimuth_window"] = {180'000, 360'000};
  EXPECT_EQ(parse(metadata).column_window, (std::pair{1, 256}));
  metadata["azimuth_window"] = {300'000, 100'000};
  EXPECT_EQ(parse(metadata).column_window, (std::pair{370, 85}));
  metadata["azimuth_window"] = {0, 360'000};
  EXPECT_EQ(parse(metadata).column_window, (std::pair{0, 511}));
  metadata["azimuth_window"] = {90'000, 90'010};
  EXPECT_EQ(parse(metadata).column_window, (std::pair{384, 384}));
  metadata["build_rev"] = "v1.14.0";
  metadata["azimuth_window"] = {18'000, 36'000};
  EXPECT_EQ(parse(metadata).column_window, (std::pair{1, 256}));
  metadata["azimuth_window"] = {180'000, 360'000};  // As written by a newer tool.
  EXPECT_EQ(parse(metadata).column_window, (std::pair{1, 256}));
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

TEST(SensorInfo, UnknownProfileIsNamedWithTheNearestAndAllKnownOnes) {
  json metadata = flat_metadata();
  metadata["data_format"]["udp_profile_lidar"] = "RNG20_RFL8_SIG16_NIR16";
  expect_refused(metadata, "udp_profile_lidar is RNG20_RFL8_SIG16_NIR16");
  expect_refused(metadata, "the nearest that it reads is RNG19_RFL8_SIG16_NIR16)");
  expect_refused(metadata, "RNG19_RFL8_SIG16_NIR16_DUAL, RNG15_RFL8_NIR8");
}

TEST(SensorInfo, SizesTellTheProfiles) {
  EXPECT_EQ(profiles_of_size(12'608, 128), "LEGACY with 64 beams");
  EXPECT_EQ(profiles_of_size(8'448, 128), "RNG15_RFL8_NIR8, RNG15_RFL8_WIN8 with 128 beams");
  EXPECT_THAT(profiles_of_size(8'448, 16),
              HasSubstr("ZONE16_DUAL, RNG19_RFL8_SIG16_NIR16_RGB16 with "
                        "32 beams; RNG15_RFL8_NIR8_DUAL, "));
  EXPECT_EQ(profiles_of_size(1, 64), "");
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

// Whatever stands in place of any value, the verdict is a MetadataError, or the value was not
// needed.
TEST(SensorInfo, WrongTypesAnywhereAreRefusedOrIgnored) {
  const std::vector<json> wrong{nullptr,
                                true,
                                -1,
                                0,
                                1e308,
                                "",
                                "x",
                                json::array(),
                                json::object(),
                                json::array({1, "x"}),
                                json::array({json::object()})};
  const json flat = json::parse(to_metadata_json(test::make_sensor(LidarProfile::kLegacy, 4, 512)));
  for (const json& whole : {flat_metadata(), flat}) {
    const json leaves = whole.flatten();
    for (const auto& [path, value] : leaves.items()) {
      for (const json& other : wrong) {
        json metadata = whole;
        metadata[json::json_pointer(path)] = other;
        // And in place of the group or list that holds it.
        json above = whole;
        above[json::json_pointer(path).parent_pointer()] = other;
        for (const json& broken : {metadata, above}) {
          try {
            parse(broken);
          } catch (const MetadataError& error) {
            EXPECT_THAT(error.what(), HasSubstr("metadata test.json"));
          }
        }
      }
    }
  }
}

TEST(SensorInfo, NumbersThatAreNoneAreRefused) {
  for (const char* number : {"NaN", "Infinity", "-Infinity", "1e400", "0x10", "1e", "--1"}) {
    const std::string text = std::string(R"({"lidar_mode":"1024x10","beam_altitude_angles":[)") +
                             number + R"(],"beam_azimuth_angles":[0]})";
    EXPECT_THROW(parse_sensor_info(text, "m"), MetadataError) << number;
  }
  json metadata = flat_metadata();
  metadata["beam_altitude_angles"] = {1e300, 0.0};
  expect_refused(metadata, "beam_altitude_angles must hold numbers from -90 to 90");
  metadata = flat_metadata();
  metadata["udp_port_lidar"] = 18446744073709551615ULL;
  expect_refused(metadata, "udp_port_lidar must be a whole number from 0 to 65535");
}

TEST(SensorInfo, TextThatIsNotFitForMessagesIsRefused) {
  json metadata = flat_metadata();
  metadata["prod_line"] = "OS-1\n64";
  expect_refused(metadata, "prod_line must be a string of at most 128 printable ASCII");
  metadata["prod_line"] = std::string(100'000, 'x');
  expect_refused(metadata, "prod_line must be");
  EXPECT_THAT([] { parse_sensor_info("{\"a\\nb\":1,\"a\\nb\":1}", "m"); },
              ThrowsMessage<MetadataError>(HasSubstr("a?b comes twice")));
}

TEST(SensorInfo, ByteOrderMarkIsReadOver) {
  EXPECT_EQ(parse_sensor_info("\xEF\xBB\xBF" + flat_metadata().dump(), "m").columns_per_frame,
            1024);
}

TEST(SensorInfo, FilesThatAreTooLargeAreNotReadWhole) {
  EXPECT_THAT([] { load_sensor_info("/dev/zero"); },
              ThrowsMessage<MetadataError>(HasSubstr("larger than 1048576 bytes")));
  EXPECT_THAT([] { load_sensor_info("/dev/null"); },
              ThrowsMessage<MetadataError>(HasSubstr("/dev/null: not JSON")));
  EXPECT_THAT([] { load_sensor_info("/"); },
              ThrowsMessage<MetadataError>(HasSubstr("cannot be read")));
}

TEST(SensorInfo, KeysOfEveryGenerationAreReadOver) {
  json metadata = flat_metadata();
  metadata["udp_ip"] = "10.0.0.1";
  metadata["auto_start_flag"] = 1;
  metadata["signal_multiplier"] = 0.25;
  const std::string old_names = to_metadata_json(parse(metadata));
  metadata.erase("udp_ip");
  metadata.erase("auto_start_flag");
  metadata["udp_dest"] = "10.0.0.1";
  metadata["operating_mode"] = "NORMAL";
  metadata["signal_multiplier"] = 2;
  metadata["a_key_of_the_future"] = {{"deep", {1, 2, 3}}};
  EXPECT_EQ(to_metadata_json(parse(metadata)), old_names);
}

TEST(SensorInfo, ShiftsMayHaveASign) {
  json metadata = flat_metadata();
  metadata["data_format"]["pixel_shift_by_row"] = {-31, 31};
  EXPECT_EQ(parse(metadata).pixel_shift_by_row, (std::vector{-31, 31}));
  metadata["data_format"]["pixel_shift_by_row"] = {-31, 2000};
  expect_refused(metadata, "pixel_shift_by_row must hold whole numbers from -1024 to 1024");
}

TEST(SensorInfo, AllZeroAnglesAreRefused) {
  json metadata = flat_metadata();
  metadata["beam_altitude_angles"] = {0, 0};
  expect_refused(metadata, "beam_altitude_angles are all zero");
}

}  // namespace
}  // namespace glint
