// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Metadata of real sensors, found through GLINT_DATA_DIR: every field read is compared with what
// the file's name says and with the raw JSON, looked up here by hand.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

fs::path data_folder() {
  const char* named = std::getenv("GLINT_DATA_DIR");
  return named != nullptr ? fs::path(named) : fs::path(GLINT_SOURCE_DIR) / "../shared/data";
}

/// A missing folder skips the test, but not on the build server.
class RealMetadata : public testing::Test {
 protected:
  std::vector<fs::path> files_of(const char* folder) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(data_folder() / folder, none)) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    const char* ci = std::getenv("CI");
    if (files.empty() && ci != nullptr && std::string_view(ci) == "true") {
      ADD_FAILURE() << "no metadata in " << data_folder() / folder << "; set GLINT_DATA_DIR";
    }
    return files;
  }
};
std::string no_data() {
  return "no metadata below " + data_folder().string() + "; set GLINT_DATA_DIR";
}

json load_json(const fs::path& file) {
  std::ifstream in(file);
  return json::parse(in);
}

/// The value under the first group that has the key; null if none has.
json raw(const json& metadata, std::initializer_list<const char*> groups, const char* key) {
  for (const char* group : groups) {
    const json* found = *group == '\0' ? &metadata : nullptr;
    if (found == nullptr && metadata.contains(group)) found = &metadata.at(group);
    if (found != nullptr && found->is_object() && found->contains(key)) return found->at(key);
  }
  return nullptr;
}

void compare_with_json(const SensorInfo& info, const json& metadata) {
  const auto sensor = [&](const char* key) { return raw(metadata, {"sensor_info", ""}, key); };
  const auto beams = [&](const char* key) { return raw(metadata, {"beam_intrinsics", ""}, key); };
  const auto config = [&](const char* key) { return raw(metadata, {"config_params", ""}, key); };
  const auto format = [&](const char* key) {
    return raw(metadata, {"lidar_data_format", "data_format"}, key);
  };
  EXPECT_EQ(info.product_line, sensor("prod_line").is_null() ? "" : sensor("prod_line"));
  EXPECT_EQ(info.serial_number, sensor("prod_sn").is_null() ? "" : sensor("prod_sn"));
  EXPECT_EQ(info.firmware, sensor("build_rev").is_null() ? "" : sensor("build_rev"));
  EXPECT_EQ(info.init_id,
            sensor("initialization_id").is_null() ? json(0) : sensor("initialization_id"));
  EXPECT_EQ(json(info.beam_altitude_deg), beams("beam_altitude_angles"));
  EXPECT_EQ(json(info.beam_azimuth_deg), beams("beam_azimuth_angles"));
  EXPECT_EQ(info.lidar_mode, config("lidar_mode"));
  EXPECT_EQ(info.lidar_port,
            config("udp_port_lidar").is_null() ? json(7502) : config("udp_port_lidar"));
  EXPECT_EQ(info.imu_port, config("udp_port_imu").is_null() ? json(7503) : config("udp_port_imu"));

  const int columns = std::stoi(info.lidar_mode);
  EXPECT_EQ(info.columns_per_frame, columns);
  EXPECT_EQ(info.scan_rate_hz, std::stod(info.lidar_mode.substr(info.lidar_mode.find('x') + 1)));
  EXPECT_EQ(info.columns_per_packet, 16);
  EXPECT_EQ(info.pixels_per_column, static_cast<int>(beams("beam_altitude_angles").size()));
  EXPECT_EQ(to_string(info.profile),
            format("udp_profile_lidar").is_null() ? json("LEGACY") : format("udp_profile_lidar"));
  const json window = format("column_window");
  EXPECT_EQ(json(info.column_window), window.is_null() ? json({0, columns - 1}) : window);
  EXPECT_EQ(info.pixel_shift_by_row.size(), info.beam_altitude_deg.size());
  if (const json shifts = format("pixel_shift_by_row"); !shifts.is_null()) {
    EXPECT_EQ(json(info.pixel_shift_by_row), shifts);
  }
}

void compare_transforms(const SensorInfo& info, const json& metadata) {
  const std::map<const char*, std::pair<json, Eigen::Matrix4d>> transforms{
      {"lidar",
       {raw(metadata, {"lidar_intrinsics", ""}, "lidar_to_sensor_transform"),
        info.lidar_to_sensor}},
      {"imu",
       {raw(metadata, {"imu_intrinsics", ""}, "imu_to_sensor_transform"), info.imu_to_sensor}},
      {"beam",
       {raw(metadata, {"beam_intrinsics", ""}, "beam_to_lidar_transform"), info.beam_to_lidar}}};
  for (const auto& [name, pair] : transforms) {
    const auto& [numbers, matrix] = pair;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      EXPECT_EQ(matrix(static_cast<int>(i) / 4, static_cast<int>(i) % 4), numbers.at(i)) << name;
    }
  }
  const json offset = raw(metadata, {"beam_intrinsics", ""}, "lidar_origin_to_beam_origin_mm");
  if (!offset.is_null()) {
    EXPECT_EQ(info.beam_to_lidar(0, 3), offset);
  }
}

TEST_F(RealMetadata, OfEveryFirmwareIsReadAsTheFileHasIt) {
  auto files = files_of("metadata");
  for (const auto& file : files_of("ouster")) files.push_back(file);
  if (files.empty()) GTEST_SKIP() << no_data();
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename());
    const SensorInfo info = load_sensor_info(file);
    compare_with_json(info, load_json(file));
    compare_transforms(info, load_json(file));
    EXPECT_NO_THROW(PacketFormat{info});
  }
}

// Names are such as 2_3_1_os-992146000760-128_legacy.json: firmware, serial number, beams.
TEST_F(RealMetadata, AgreesWithTheNameOfItsFile) {
  const auto files = files_of("metadata");
  if (files.empty()) GTEST_SKIP() << no_data();
  EXPECT_GE(files.size(), 18U);
  const std::regex pattern(R"((\d+)_(\d+)(?:_(\d+)(?=_))?\w*_os1?-(\d+)-(\d+)(A0|U0)?.*)");
  for (const fs::path& file : files) {
    const std::string name = file.stem();
    SCOPED_TRACE(name);
    const SensorInfo info = load_sensor_info(file);
    std::smatch parts;
    ASSERT_TRUE(std::regex_match(name, parts, pattern));
    const std::string version =
        "v" + parts.str(1) + "." + parts.str(2) + (parts.str(3).empty() ? "." : "." + parts.str(3));
    EXPECT_THAT(info.firmware, testing::StartsWith(version));
    EXPECT_EQ(info.serial_number, parts.str(4));
    EXPECT_THAT(info.product_line, HasSubstr("-" + parts.str(5)));
    // Before 1.14 sensors of fewer beams sent 64 rows, those that are not there empty.
    const bool old = info.firmware < "v1.14";
    EXPECT_EQ(info.pixels_per_column, old ? 64 : std::stoi(parts.str(5)));
  }
}

TEST_F(RealMetadata, MalformedIsRefusedEachForItsOwnReason) {
  const std::map<std::string, std::string> reasons{
      {"complete_but_all_zeros_legacy.json", "beam_altitude_angles are all zero"},
      {"garbled_legacy_and_nonlegacy.json", "a mixture of the flat and the grouped form"},
      {"incomplete_data_format_legacy.json", "data_format.columns_per_frame is missing"},
      {"incomplete_no_sensor_info_nonlegacy.json", "sensor_info is missing"},
      {"incorrect_nbeam_angles_legacy_113.json",
       "beam_altitude_angles has 63 entries but beam_azimuth_angles has 64"}};
  const auto files = files_of("malformed");
  if (files.empty()) GTEST_SKIP() << no_data();
  EXPECT_EQ(files.size(), reasons.size());
  for (const fs::path& file : files) {
    const std::string name = file.filename();
    // File, key with what is wrong, and the way out.
    EXPECT_THAT([&] { load_sensor_info(file); },
                testing::ThrowsMessage<MetadataError>(
                    AllOf(HasSubstr(name + ": "), HasSubstr(reasons.at(name)),
                          testing::ContainsRegex("get (it|the metadata) again"))));
  }
}

}  // namespace
}  // namespace glint
