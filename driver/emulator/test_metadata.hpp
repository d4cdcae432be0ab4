// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glint::emulator::test {

/// Metadata of a small sensor, as short as it may be.
inline std::string metadata() {
  const std::vector<double> altitudes = {3.0, 1.0, -1.0, -3.0};
  const std::vector<double> azimuths = {1.0, 0.5, 0.5, 1.0};
  const nlohmann::json json = {
      {"sensor_info",
       {{"prod_line", "OS-1-64"}, {"prod_sn", "122246000293"}, {"build_rev", "v3.0.1"}}},
      {"config_params", {{"lidar_mode", "512x10"}, {"udp_dest", "127.0.0.9"}}},
      {"lidar_data_format",
       {{"udp_profile_lidar", "LEGACY"},
        {"columns_per_frame", 512},
        {"columns_per_packet", 16},
        {"pixels_per_column", 4},
        {"column_window", {0, 511}},
        {"pixel_shift_by_row", {0, 0, 0, 0}}}},
      {"beam_intrinsics",
       {{"beam_altitude_angles", altitudes}, {"beam_azimuth_angles", azimuths}}}};
  return json.dump();
}

}  // namespace glint::emulator::test
