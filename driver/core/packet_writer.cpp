// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_writer.hpp"

#include <algorithm>
#include <charconv>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/profile_table.hpp"

namespace glint {
namespace {

constexpr std::uint64_t kSerialNumberMask = 0xFF'FFFF'FFFFU;
constexpr std::uint32_t kInitIdMask = 0xFF'FFFFU;

// ORs a value into its place: the fields of a pixel share bytes.
void write_field(const PixelField& field, std::uint32_t value, std::byte* pixel) {
  const std::uint32_t largest = (1U << field.width_bits) - 1U;
  const std::uint32_t bits = std::min(value / static_cast<std::uint32_t>(field.scale), largest);
  std::byte* to = pixel + field.offset_bits / 8;
  for (int shift = 0; shift < field.width_bits; shift += 8) {
    *to++ |= static_cast<std::byte>((bits >> shift) & 0xFFU);
  }
}

void write_pixels(const PacketFormat& format, const LidarScan& scan, int m, std::byte* pixels) {
  const auto write_channel = [&]<class T>(Channel channel, const Image<T>& image) {
    if (image.empty() || !format.has(channel)) return;
    for (int r = 0; r < format.pixels_per_column; ++r) {
      write_field(format.layout->field(channel), image(r, m),
                  pixels + static_cast<std::ptrdiff_t>(r) * format.layout->pixel_bytes);
    }
  };
  write_channel(Channel::kRange, scan.range_mm);
  write_channel(Channel::kSignal, scan.signal);
  write_channel(Channel::kReflectivity, scan.reflectivity);
  write_channel(Channel::kNearIr, scan.near_ir);
  write_channel(Channel::kRange2, scan.range2_mm);
  write_channel(Channel::kSignal2, scan.signal2);
  write_channel(Channel::kReflectivity2, scan.reflectivity2);
}

void write_column(const PacketFormat& format, const LidarScan& scan, int m, std::byte* column) {
  const auto index = static_cast<std::size_t>(m);
  store(column + kColumnTimeOffset, scan.column_time[index].ns + format.stamp_excess_ns);
  store(column + kMeasurementIdOffset, static_cast<std::uint16_t>(m));
  const std::uint32_t status = scan.column_status[index];
  if (format.legacy()) {
    store(column + kLegacyFrameIdOffset, static_cast<std::uint16_t>(scan.frame_id));
    const auto ticks = kEncoderTicksPerTurn / static_cast<std::uint32_t>(format.columns_per_frame);
    store(column + kLegacyEncoderOffset, static_cast<std::uint32_t>(m) * ticks);
    store(column + format.column_bytes - sizeof status, status);
  } else {
    store(column + kColumnStatusOffset, static_cast<std::uint16_t>(status));
  }
  write_pixels(format, scan, m, column + format.layout->column_header_bytes);
}

}  // namespace

PacketWriter::PacketWriter(const SensorInfo& info)
    : format_(info), init_id_(info.init_id & kInitIdMask), serial_number_(0) {
  const std::string& serial = info.serial_number;
  std::from_chars(serial.data(), serial.data() + serial.size(), serial_number_);
  serial_number_ &= kSerialNumberMask;
}

int PacketWriter::packets_per_scan() const {
  return format_.columns_per_frame / format_.columns_per_packet;
}

void PacketWriter::write(const LidarScan& scan, int index, std::vector<std::byte>& out) const {
  out.assign(format_.packet_bytes, std::byte{0});
  std::byte* to = out.data();
  if (!format_.legacy()) write_header(scan.frame_id, to);
  to += format_.layout->packet_header_bytes;
  for (int i = 0; i < format_.columns_per_packet; ++i, to += format_.column_bytes) {
    write_column(format_, scan, index * format_.columns_per_packet + i, to);
  }
  if (format_.legacy()) return;
  const std::size_t covered = out.size() - kPacketCrcBytes;
  store(out.data() + covered, crc64(std::span(out).first(covered)));
}

void PacketWriter::write_header(std::uint32_t frame_id, std::byte* to) const {
  const HeaderLayout& layout = header_layout(format_.header);
  // Words first: what is narrower lies over their unused bits.
  store(to + layout.serial_number_offset, serial_number_);
  const std::byte after_init_id = to[layout.init_id_offset + 3];
  store(to + layout.init_id_offset, init_id_);
  to[layout.init_id_offset + 3] = after_init_id;
  if (format_.header == PacketHeader::kFusa) {
    store(to + layout.frame_id_offset, frame_id);
    store(to, static_cast<std::uint8_t>(kLidarPacketType));
  } else {
    store(to + layout.frame_id_offset, static_cast<std::uint16_t>(frame_id));
    store(to, kLidarPacketType);
  }
}

}  // namespace glint
