// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_format.hpp"

#include <fmt/format.h>

#include "driver/core/imu_packet.hpp"
#include "driver/core/profile_table.hpp"

namespace glint {
namespace {

constexpr std::size_t kMaxUdpPayloadBytes = 65'507;

}  // namespace

const ProfileLayout& profile_layout(LidarProfile profile) {
  return kProfileTable[static_cast<std::size_t>(profile)];
}

PacketFormat::PacketFormat(const SensorInfo& info)
    : layout(&profile_layout(info.profile)),
      columns_per_frame(info.columns_per_frame),
      columns_per_packet(info.columns_per_packet),
      pixels_per_column(info.pixels_per_column),
      header(info.profile == LidarProfile::kFusaRng15Rfl8Nir8Dual ? PacketHeader::kFusa
                                                                  : info.header),
      stamp_excess_ns(info.stamp_excess_ns()),
      imu_packet_bytes(ImuPacketFormat(info).packet_bytes) {
  const auto bytes = [](int count) { return static_cast<std::size_t>(count); };
  column_bytes = bytes(layout->column_header_bytes) +
                 bytes(pixels_per_column) * bytes(layout->pixel_bytes) +
                 bytes(layout->column_footer_bytes);
  packet_bytes = bytes(layout->packet_header_bytes) + bytes(columns_per_packet) * column_bytes +
                 bytes(layout->packet_footer_bytes);
  if (packet_bytes > kMaxUdpPayloadBytes) {
    throw MetadataError(fmt::format(
        "the metadata describes lidar packets of {} bytes ({} columns of {} pixels, profile {}), "
        "which "
        "no UDP datagram can carry; take the metadata of this sensor in its present configuration",
        packet_bytes, columns_per_packet, pixels_per_column, to_string(info.profile)));
  }
}

}  // namespace glint
