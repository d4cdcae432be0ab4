// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/test_sensor.hpp"

#include <algorithm>

#include "driver/core/packet_writer.hpp"

namespace glint::test {
namespace {

constexpr std::int64_t kStreamStart_ns = 1'000'000'000'000;

// Calls fn(channel, image) for every image of a scan.
template <class Scan, class Fn>
void for_each_image(Scan& scan, Fn fn) {
  fn(Channel::kRange, scan.range_mm);
  fn(Channel::kSignal, scan.signal);
  fn(Channel::kReflectivity, scan.reflectivity);
  fn(Channel::kNearIr, scan.near_ir);
  fn(Channel::kRange2, scan.range2_mm);
  fn(Channel::kSignal2, scan.signal2);
  fn(Channel::kReflectivity2, scan.reflectivity2);
}

}  // namespace

SensorInfo make_sensor(LidarProfile profile, int rows, int columns) {
  SensorInfo info;
  info.product_line = "OS-1-64";
  info.serial_number = "122201000998";
  info.firmware = "v2.3.0";
  info.lidar_mode = std::to_string(columns) + "x10";
  info.init_id = profile == LidarProfile::kLegacy ? 0 : 7'109'750;
  info.profile = profile;
  info.columns_per_frame = columns;
  info.columns_per_packet = 16;
  info.pixels_per_column = rows;
  info.column_window = {0, columns - 1};
  for (int r = 0; r < rows; ++r) {
    info.pixel_shift_by_row.push_back(12 - 8 * (r % 4));
    info.beam_altitude_deg.push_back(20.0 - 40.0 * r / std::max(rows - 1, 1));
    info.beam_azimuth_deg.push_back(4.2 - 2.8 * (r % 4));
  }
  info.beam_to_lidar(0, 3) = 15.806;
  info.lidar_to_sensor.diagonal() << -1, -1, 1, 1;
  info.lidar_to_sensor(2, 3) = 36.18;
  info.imu_to_sensor.topRightCorner<3, 1>() << 6.253, -11.775, 7.645;
  return info;
}

SensorTime nominal_time(const SensorInfo& info, std::int64_t scan, int column) {
  const std::int64_t period_ns = info.scan_period_ns();
  return {kStreamStart_ns + scan * period_ns + column * period_ns / info.columns_per_frame};
}

LidarScan random_scan(const SensorInfo& info, std::uint32_t frame_id, std::mt19937& random) {
  const PacketFormat format(info);
  LidarScan scan(format);
  scan.frame_id = frame_id;
  for_each_image(scan, [&]<class T>(Channel channel, Image<T>& image) {
    const PixelField& field = format.layout->field(channel);
    std::uniform_int_distribution<std::uint32_t> bits(0, (1U << field.width_bits) - 1U);
    for (T& pixel : image.data) {
      pixel = static_cast<T>(bits(random) * static_cast<std::uint32_t>(field.scale));
    }
  });
  for (int m = 0; m < info.columns_per_frame; ++m) {
    const auto column = static_cast<std::size_t>(m);
    scan.column_time[column] = nominal_time(info, frame_id, m);
    scan.column_status[column] = format.legacy() ? 0xFFFF'FFFFU : 1U;
  }
  return scan;
}

std::vector<Bytes> encode(const SensorInfo& info, const LidarScan& scan) {
  const PacketWriter writer(info);
  std::vector<Bytes> packets(static_cast<std::size_t>(writer.packets_per_scan()));
  for (int i = 0; i < writer.packets_per_scan(); ++i) {
    writer.write(scan, i, packets[static_cast<std::size_t>(i)]);
  }
  return packets;
}

void clear_columns(LidarScan& scan, int begin, int end) {
  for_each_image(scan, [&]<class T>(Channel, Image<T>& image) {
    for (int r = 0; r < image.rows; ++r) {
      for (int m = begin; m < end; ++m) image(r, m) = 0;
    }
  });
  for (int m = begin; m < end; ++m) {
    scan.column_time[static_cast<std::size_t>(m)] = {};
    scan.column_status[static_cast<std::size_t>(m)] = 0;
  }
}

bool same_columns(const LidarScan& a, const LidarScan& b) {
  return a.range_mm.data == b.range_mm.data && a.signal.data == b.signal.data &&
         a.reflectivity.data == b.reflectivity.data && a.near_ir.data == b.near_ir.data &&
         a.range2_mm.data == b.range2_mm.data && a.signal2.data == b.signal2.data &&
         a.reflectivity2.data == b.reflectivity2.data && a.column_time == b.column_time &&
         a.column_status == b.column_status;
}

}  // namespace glint::test
