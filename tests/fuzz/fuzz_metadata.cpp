// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Metadata JSON.
#include "driver/core/error.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using glint::fuzz::require;

void check(const glint::SensorInfo& info) {
  const auto rows = static_cast<std::size_t>(info.pixels_per_column);
  require(rows > 0 && rows <= 256, "there are beams");
  require(info.beam_altitude_deg.size() == rows && info.beam_azimuth_deg.size() == rows &&
              info.pixel_shift_by_row.size() == rows,
          "lists have an entry for each beam");
  require(info.columns_per_packet > 0 && info.columns_per_frame % info.columns_per_packet == 0,
          "packets divide a scan");
  require(info.column_window.first >= 0 && info.column_window.first < info.columns_per_frame &&
              info.column_window.second >= 0 && info.column_window.second < info.columns_per_frame,
          "the window is within the scan");
  require(info.scan_period_ns() > 0, "scans take time");
  require(info.beam_to_lidar.allFinite() && info.lidar_to_sensor.allFinite() &&
              info.imu_to_sensor.allFinite(),
          "transforms are finite");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto info = glint::parse_sensor_info(glint::fuzz::as_text(data, size), "fuzz");
    check(info);
    const std::string written = glint::to_metadata_json(info);
    const auto read = glint::parse_sensor_info(written, "written");
    check(read);
    require(glint::to_metadata_json(read) == written, "what is written reads back equal");
    const glint::PacketFormat format(info);
    require(format.packet_bytes <= 65'507, "packets fit a datagram");
  } catch (const glint::MetadataError&) {
    // The verdict that most inputs deserve.
  }
  return 0;
}
