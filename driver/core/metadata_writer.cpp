// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <nlohmann/json.hpp>

#include "driver/core/sensor_info.hpp"

namespace glint {
namespace {

std::vector<double> row_major(const Eigen::Matrix4d& matrix) {
  std::vector<double> numbers;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) numbers.push_back(matrix(r, c));
  }
  return numbers;
}

}  // namespace

std::string to_metadata_json(const SensorInfo& info) {
  nlohmann::ordered_json json;
  json["sensor_info"] = {{"prod_line", info.product_line},
                         {"prod_sn", info.serial_number},
                         {"build_rev", info.firmware},
                         {"initialization_id", info.init_id}};
  auto& config = json["config_params"];
  if (!info.lidar_mode.empty()) config["lidar_mode"] = info.lidar_mode;
  config["timestamp_mode"] = to_timestamp_mode(info.clock);
  config["udp_port_lidar"] = info.lidar_port;
  config["udp_port_imu"] = info.imu_port;
  json["lidar_data_format"] = {
      {"udp_profile_lidar", to_string(info.profile)},
      {"udp_profile_imu", to_string(info.imu_profile)},
      {"columns_per_frame", info.columns_per_frame},
      {"columns_per_packet", info.columns_per_packet},
      {"pixels_per_column", info.pixels_per_column},
      {"header_type", info.header == PacketHeader::kFusa ? "FUSA" : "STANDARD"},
      {"fps", info.scan_rate_hz},
      {"column_window", {info.column_window.first, info.column_window.second}},
      {"pixel_shift_by_row", info.pixel_shift_by_row}};
  if (info.imu_profile != ImuProfile::kLegacy) {
    json["imu_data_format"] = {{"imu_measurements_per_packet", info.imu_measurements_per_packet},
                               {"imu_packets_per_frame", info.imu_packets_per_frame}};
  }
  json["beam_intrinsics"] = {{"beam_altitude_angles", info.beam_altitude_deg},
                             {"beam_azimuth_angles", info.beam_azimuth_deg},
                             {"beam_to_lidar_transform", row_major(info.beam_to_lidar)}};
  json["lidar_intrinsics"] = {{"lidar_to_sensor_transform", row_major(info.lidar_to_sensor)}};
  json["imu_intrinsics"] = {{"imu_to_sensor_transform", row_major(info.imu_to_sensor)}};
  return json.dump(2);
}

}  // namespace glint
