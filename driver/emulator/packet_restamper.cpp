// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/packet_restamper.hpp"

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/imu_packet_layout.hpp"
#include "driver/core/profile_table.hpp"

namespace glint::emulator {
namespace {

constexpr std::uint32_t kInitIdMask = 0xFF'FFFF;

void shift_time(std::byte* at, const PacketStamp& stamp) {
  const auto time = load<std::uint64_t>(at);
  if (time != 0) store(at, time + static_cast<std::uint64_t>(stamp.time_shift_ns));
}

template <class FrameId>
void shift_frame_id(std::byte* at, const PacketStamp& stamp) {
  store(at, static_cast<FrameId>(load<FrameId>(at) + stamp.frame_shift));
}

void write_ids(std::byte* packet, PacketHeader header, const PacketStamp& stamp) {
  const HeaderLayout& layout = header_layout(header);
  if (header == PacketHeader::kFusa) {
    shift_frame_id<std::uint32_t>(packet + layout.frame_id_offset, stamp);
  } else {
    shift_frame_id<std::uint16_t>(packet + layout.frame_id_offset, stamp);
  }
  if (stamp.init_id == 0) return;
  std::byte* const at = packet + layout.init_id_offset;
  store(at, (load<std::uint32_t>(at) & ~kInitIdMask) | (stamp.init_id & kInitIdMask));
}

}  // namespace

bool PacketRestamper::restamp_lidar(std::span<std::byte> packet, const PacketStamp& stamp) const {
  if (packet.size() != format_.packet_bytes) return false;
  std::byte* column = packet.data() + format_.layout->packet_header_bytes;
  for (int i = 0; i < format_.columns_per_packet; ++i, column += format_.column_bytes) {
    shift_time(column + kColumnTimeOffset, stamp);
    if (format_.legacy()) shift_frame_id<std::uint16_t>(column + kLegacyFrameIdOffset, stamp);
  }
  if (format_.legacy()) return true;
  write_ids(packet.data(), format_.header, stamp);
  finish(packet);
  return true;
}

bool PacketRestamper::restamp_imu(std::span<std::byte> packet, const PacketStamp& stamp) const {
  if (packet.size() != imu_.packet_bytes) return false;
  if (imu_.profile == ImuProfile::kLegacy) {
    for (const int at : {0, kLegacyImuAccelTimeOffset, kLegacyImuGyroTimeOffset}) {
      shift_time(packet.data() + at, stamp);
    }
    return true;
  }
  write_ids(packet.data(), PacketHeader::kStandard, stamp);
  shift_time(packet.data() + kImuHeaderBytes, stamp);  // Of the NMEA sentence.
  std::byte* measurement = packet.data() + kImuHeaderBytes + kImuNmeaBytes;
  for (int i = 0; i < imu_.measurements; ++i, measurement += kImuMeasurementBytes) {
    shift_time(measurement + kImuTimeOffset, stamp);
  }
  finish(packet);
  return true;
}

bool PacketRestamper::change_serial_number(std::span<std::byte> packet) const {
  if (format_.legacy() || packet.size() != format_.packet_bytes) return false;
  packet[static_cast<std::size_t>(header_layout(format_.header).serial_number_offset)] ^=
      std::byte{1};
  finish(packet);
  return true;
}

void PacketRestamper::finish(std::span<std::byte> packet) const {
  if (!write_crc_) return;
  const auto covered = packet.first(packet.size() - kPacketCrcBytes);
  store(packet.data() + covered.size(), crc64(covered));
}

}  // namespace glint::emulator
