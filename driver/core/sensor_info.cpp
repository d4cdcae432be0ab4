// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/sensor_info.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "driver/core/azimuth_window.hpp"
#include "driver/core/metadata_json.hpp"
#include "driver/core/profile_names.hpp"
#include "driver/core/sensor_defaults.hpp"

namespace glint {
namespace {

// Far above any sensor; keeps sizes computed from metadata small enough to allocate.
constexpr int kMaxColumnsPerFrame = 8192;
constexpr int kMaxPixelsPerColumn = 256;
constexpr int kMaxImuMeasurementsPerPacket = 1024;
constexpr int kMaxImuPacketsPerFrame = 64;
constexpr int kMaxInitId = 0xFF'FFFF;  // 24 bits on the wire
constexpr double kMaxTranslation_mm = 10'000.0;
constexpr double kDefaultScanRate_hz = 10.0;
constexpr int kDefaultColumnsPerPacket = 16;

// The two forms of metadata, seen alike: in the flat one all groups but the data format are the
// whole document.
struct Groups {
  MetadataGroup sensor, beams, lidar, imu, format, imu_format, config;
};

Groups find_groups(const MetadataGroup& root) {
  constexpr std::array kGroupNames{"sensor_info",      "beam_intrinsics", "lidar_data_format",
                                   "lidar_intrinsics", "imu_intrinsics",  "config_params"};
  constexpr std::array kFlatKeys{
      "beam_altitude_angles",      "beam_azimuth_angles",     "data_format", "lidar_mode",
      "lidar_to_sensor_transform", "imu_to_sensor_transform", "prod_line",   "prod_sn"};
  const auto* group = std::find_if(kGroupNames.begin(), kGroupNames.end(),
                                   [&](const char* key) { return !root.group(key).absent(); });
  if (group == kGroupNames.end()) {
    return {root, root, root, root, root.group("data_format"), root.group("imu_data_format"), root};
  }
  for (const char* key : kFlatKeys) {
    if (!root.has(key)) continue;
    root.fail(key, fmt::format("stands beside the group {}, a mixture of the flat and the grouped "
                               "form of metadata; get it again from the sensor",
                               *group));
  }
  Groups groups{root.group("sensor_info"),       root.group("beam_intrinsics"),
                root.group("lidar_intrinsics"),  root.group("imu_intrinsics"),
                root.group("lidar_data_format"), root.group("imu_data_format"),
                root.group("config_params")};
  if (groups.sensor.absent()) {
    root.fail("sensor_info", "is missing, so the sensor is unknown; get the metadata again");
  }
  return groups;
}

template <class T>
T require(const std::optional<T>& value, const MetadataGroup& group, const char* key) {
  if (!value) group.fail(key, "is missing; get the metadata again from the sensor");
  return *value;
}

// Columns and scans per second of a mode such as "1024x10".
std::optional<std::pair<int, double>> parse_lidar_mode(const std::string& mode) {
  const char* const end = mode.data() + mode.size();
  int columns = 0;
  int rate_hz = 0;
  const auto [x, columns_error] = std::from_chars(mode.data(), end, columns);
  if (columns_error != std::errc{} || x == end || *x != 'x') return std::nullopt;
  const auto [rest, rate_error] = std::from_chars(x + 1, end, rate_hz);
  if (rate_error != std::errc{} || rest != end) return std::nullopt;
  if (columns < 1 || columns > kMaxColumnsPerFrame || rate_hz < 1 || rate_hz > 100) {
    return std::nullopt;
  }
  return std::pair{columns, static_cast<double>(rate_hz)};
}

void read_identity(const Groups& groups, SensorInfo& info) {
  info.product_line = groups.sensor.text("prod_line").value_or("");
  info.serial_number = groups.sensor.text("prod_sn").value_or("");
  info.firmware = groups.sensor.text("build_rev").value_or("");
  info.init_id = static_cast<std::uint32_t>(
      groups.sensor.integer("initialization_id", 0, kMaxInitId).value_or(0));
  info.lidar_port = groups.config.integer("udp_port_lidar", 0, 65535).value_or(info.lidar_port);
  info.imu_port = groups.config.integer("udp_port_imu", 0, 65535).value_or(info.imu_port);
}

void read_beams(const Groups& groups, SensorInfo& info) {
  const MetadataGroup& beams = groups.beams;
  info.beam_altitude_deg =
      require(beams.numbers("beam_altitude_angles", -90.0, 90.0), beams, "beam_altitude_angles");
  info.beam_azimuth_deg =
      require(beams.numbers("beam_azimuth_angles", -360.0, 360.0), beams, "beam_azimuth_angles");
  const std::size_t rows = info.beam_altitude_deg.size();
  if (rows == 0 || rows > kMaxPixelsPerColumn) {
    beams.fail("beam_altitude_angles", fmt::format("has {} entries; sensors have 1 to {} beams",
                                                   rows, kMaxPixelsPerColumn));
  }
  if (info.beam_azimuth_deg.size() != rows) {
    beams.fail("beam_altitude_angles",
               fmt::format("has {} entries but beam_azimuth_angles has {}; get the metadata again",
                           rows, info.beam_azimuth_deg.size()));
  }
  if (std::ranges::all_of(info.beam_altitude_deg, [](double angle) { return angle == 0.0; })) {
    beams.fail("beam_altitude_angles",
               "are all zero, the mark of a sensor without calibration; get the metadata again");
  }
  info.pixels_per_column = static_cast<int>(rows);
}

PacketHeader read_header(const MetadataGroup& format, LidarProfile profile) {
  const std::string type = format.text("header_type").value_or("STANDARD");
  if (type != "STANDARD" && type != "FUSA") {
    format.fail("header_type", fmt::format("is {}; sensors have STANDARD or FUSA", type));
  }
  const bool fusa = type == "FUSA" || profile == LidarProfile::kFusaRng15Rfl8Nir8Dual;
  return fusa ? PacketHeader::kFusa : PacketHeader::kStandard;
}

void read_profile(const MetadataGroup& format, SensorInfo& info) {
  const std::string name = format.text("udp_profile_lidar").value_or("LEGACY");
  if (name == "OFF") {
    format.fail("udp_profile_lidar",
                "is OFF: the sensor sends no lidar packets; set it to RNG19_RFL8_SIG16_NIR16");
  }
  const auto profile = lidar_profile_named(name);
  if (!profile) {
    format.fail(
        "udp_profile_lidar",
        fmt::format("is {}, a profile this version does not read (the nearest that it reads "
                    "is {}); set the sensor to one of {}",
                    name, to_string(nearest_lidar_profile(name)), lidar_profile_list()));
  }
  info.profile = *profile;
  info.header = read_header(format, info.profile);
}

// The IMU is no reason to refuse a sensor, so an unknown profile only warns.
void read_imu_format(const Groups& groups, SensorInfo& info) {
  const auto said = groups.format.text("udp_profile_imu");
  const std::string name = said ? *said : groups.config.text("udp_profile_imu").value_or("LEGACY");
  const auto profile = imu_profile_named(name);
  if (!profile) {
    info.warnings.push_back(
        fmt::format("IMU packets of profile {} are not read; set udp_profile_imu to LEGACY or "
                    "ACCEL32_GYRO32_NMEA to use the IMU",
                    name));
    return;
  }
  info.imu_profile = *profile;
  const MetadataGroup& imu = groups.imu_format;
  if (info.imu_profile == ImuProfile::kLegacy) return;
  info.imu_measurements_per_packet =
      imu.integer("imu_measurements_per_packet", 1, kMaxImuMeasurementsPerPacket)
          .value_or(info.imu_measurements_per_packet);
  info.imu_packets_per_frame = imu.integer("imu_packets_per_frame", 1, kMaxImuPacketsPerFrame)
                                   .value_or(info.imu_packets_per_frame);
}

// Number of columns and rate: from the data format, else from the lidar mode.
void read_mode(const Groups& groups, SensorInfo& info) {
  info.lidar_mode = groups.config.text("lidar_mode").value_or("");
  const auto mode = parse_lidar_mode(info.lidar_mode);
  if (!info.lidar_mode.empty() && !mode) {
    groups.config.fail("lidar_mode",
                       fmt::format("is {}, which is not of the form 1024x10; get the metadata "
                                   "again from the sensor",
                                   info.lidar_mode));
  }
  if (groups.format.absent()) {
    if (!mode) {
      groups.config.fail("lidar_mode",
                         "is missing and there is no data format either, so the "
                         "number of columns is unknown; add lidar_mode");
    }
    info.columns_per_frame = mode->first;
    info.warnings.push_back(fmt::format(
        "the metadata holds no data format, so the LEGACY profile with {} columns a packet and the "
        "pixel shifts of a first-generation sensor are assumed",
        kDefaultColumnsPerPacket));
  } else {
    info.columns_per_frame =
        require(groups.format.integer("columns_per_frame", 1, kMaxColumnsPerFrame), groups.format,
                "columns_per_frame");
  }
  if (mode && mode->first != info.columns_per_frame) {
    info.warnings.push_back(fmt::format(
        "the metadata's data format has {} columns but its lidar_mode is {}; the data format holds",
        info.columns_per_frame, info.lidar_mode));
  }
  if (!mode && !groups.format.has("fps")) {
    info.warnings.push_back(fmt::format(
        "the metadata says no lidar_mode, so {} scans a second are assumed", kDefaultScanRate_hz));
  }
  info.scan_rate_hz =
      groups.format.number("fps", 0.1, 100.0).value_or(mode ? mode->second : kDefaultScanRate_hz);
}

// Firmware 1.x tells the azimuth window only, from which the columns follow.
void read_windows(const Groups& groups, SensorInfo& info) {
  const int columns = info.columns_per_frame;
  const int firmware = firmware_major(info);
  const auto azimuth = read_azimuth_window(groups.config, firmware);
  if (azimuth) {
    const std::string warning = azimuth_window_warning(*azimuth, firmware);
    if (!warning.empty()) info.warnings.push_back(warning);
  }
  const auto window = groups.format.integers("column_window", 0, columns - 1);
  if (window && window->size() != 2) {
    groups.format.fail("column_window", "must hold two columns; get the metadata again");
  }
  info.column_window = window ? std::pair{window->front(), window->back()}
                              : azimuth.value_or(AzimuthWindow{}).columns(columns);
}

void read_clock(const Groups& groups, SensorInfo& info) {
  const auto mode = groups.config.text("timestamp_mode");
  if (!mode) return;
  if (const auto clock = clock_of_timestamp_mode(*mode)) {
    info.clock = *clock;
    return;
  }
  info.warnings.push_back(fmt::format(
      "the metadata's timestamp_mode {} is not known, so times are taken to be those of the "
      "sensor's oscillator; say what they are with sensor.clock",
      *mode));
}

void read_data_format(const Groups& groups, SensorInfo& info) {
  const MetadataGroup& format = groups.format;
  read_profile(format, info);
  read_mode(groups, info);
  const int columns = info.columns_per_frame;
  const int rows = info.pixels_per_column;
  info.columns_per_packet =
      format.integer("columns_per_packet", 1, columns).value_or(kDefaultColumnsPerPacket);
  if (columns % info.columns_per_packet != 0) {
    format.fail("columns_per_packet",
                fmt::format("is {}, which does not divide the {} columns of a "
                            "scan; get the metadata again",
                            info.columns_per_packet, columns));
  }
  const int said_rows = format.integer("pixels_per_column", 1, kMaxPixelsPerColumn).value_or(rows);
  if (said_rows != rows) {
    format.fail("pixels_per_column", fmt::format("is {} but there are {} beam angles; get the "
                                                 "metadata again",
                                                 said_rows, rows));
  }
  const auto shifts = format.integers("pixel_shift_by_row", -columns, columns);
  info.pixel_shift_by_row = shifts ? *shifts : default_pixel_shifts(info);
  if (info.pixel_shift_by_row.size() != static_cast<std::size_t>(rows)) {
    format.fail("pixel_shift_by_row", fmt::format("has {} entries but there are {} beams; get the "
                                                  "metadata again",
                                                  info.pixel_shift_by_row.size(), rows));
  }
  read_windows(groups, info);
}

// A rigid motion given as 16 numbers, row by row, in mm.
std::optional<Eigen::Matrix4d> read_transform(const MetadataGroup& group, const char* key) {
  const auto numbers = group.numbers(key, -kMaxTranslation_mm, kMaxTranslation_mm);
  if (!numbers) return std::nullopt;
  if (numbers->size() != 16) group.fail(key, "must hold 16 numbers, a 4x4 matrix row by row");
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers->data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-3;  // the digits that metadata is rounded to
  if (!(rotation * rotation.transpose()).isIdentity(kTolerance) || rotation.determinant() < 0 ||
      matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    group.fail(key, "is no rigid motion; get the metadata again from the sensor");
  }
  return matrix;
}

void read_transforms(const Groups& groups, SensorInfo& info) {
  const auto beam_origin_mm = groups.beams.number("lidar_origin_to_beam_origin_mm",
                                                  -kMaxTranslation_mm, kMaxTranslation_mm);
  info.beam_to_lidar = Eigen::Matrix4d::Identity();
  info.beam_to_lidar(0, 3) = beam_origin_mm.value_or(default_beam_origin_mm(info));
  info.beam_to_lidar =
      read_transform(groups.beams, "beam_to_lidar_transform").value_or(info.beam_to_lidar);
  info.lidar_to_sensor = read_transform(groups.lidar, "lidar_to_sensor_transform")
                             .value_or(default_lidar_to_sensor(info));
  info.imu_to_sensor =
      read_transform(groups.imu, "imu_to_sensor_transform").value_or(default_imu_to_sensor(info));
}

}  // namespace

SensorInfo parse_sensor_info(std::string_view json, std::string_view name) {
  const nlohmann::json document = parse_metadata_json(json, name);
  const Groups groups = find_groups(MetadataGroup(&document, name, ""));
  SensorInfo info;
  read_identity(groups, info);
  read_beams(groups, info);
  read_data_format(groups, info);
  read_imu_format(groups, info);
  read_transforms(groups, info);
  read_clock(groups, info);
  return info;
}

SensorInfo load_sensor_info(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) {
    throw MetadataError(fmt::format(
        "metadata {}: the file cannot be read; name the sensor's metadata file", file.string()));
  }
  // One byte more than is allowed, so that a file that is larger, or endless, is told from one that
  // is not.
  std::string json(kMaxMetadataBytes + 1, '\0');
  in.read(json.data(), static_cast<std::streamsize>(json.size()));
  json.resize(static_cast<std::size_t>(in.gcount()));
  return parse_sensor_info(json, file.string());
}

}  // namespace glint
