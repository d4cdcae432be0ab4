// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_view.hpp"

#include <algorithm>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/profile_table.hpp"

namespace glint {
namespace {

std::optional<PacketView> refuse(PacketError why, PacketError* error) {
  if (error != nullptr) *error = why;
  return std::nullopt;
}

}  // namespace

SensorTime ColumnView::time() const {
  constexpr std::uint64_t kLatest_ns = 1ULL << 62U;
  const auto stamp_ns = std::min(load<std::uint64_t>(data_ + kColumnTimeOffset), kLatest_ns);
  return {static_cast<std::int64_t>(stamp_ns) - format_->stamp_excess_ns};
}

std::uint16_t ColumnView::measurement_id() const {
  return load<std::uint16_t>(data_ + kMeasurementIdOffset);
}

std::uint32_t ColumnView::status() const {
  if (!format_->legacy()) return load<std::uint16_t>(data_ + kColumnStatusOffset);
  return load<std::uint32_t>(data_ + format_->column_bytes - sizeof(std::uint32_t));
}

std::uint16_t ColumnView::legacy_frame_id() const {
  return load<std::uint16_t>(data_ + kLegacyFrameIdOffset);
}

const std::byte* ColumnView::pixels() const { return data_ + format_->layout->column_header_bytes; }

std::uint32_t ColumnView::value(Channel channel, int row) const {
  const PixelField& field = format_->layout->field(channel);
  if (!field.present()) return 0;
  const std::byte* from = pixels() +
                          static_cast<std::ptrdiff_t>(row) * format_->layout->pixel_bytes +
                          field.offset_bits / 8;
  std::uint32_t bits = 0;
  std::memcpy(&bits, from, static_cast<std::size_t>(field.width_bits + 7) / 8);
  const std::uint32_t mask = (1U << field.width_bits) - 1U;
  return (bits & mask) * static_cast<std::uint32_t>(field.scale);
}

namespace {

constexpr std::size_t kHeaderBytes = 32;

const HeaderLayout& layout_of(const PacketFormat& format) { return header_layout(format.header); }

std::uint16_t type_of(const HeaderLayout& layout, const std::byte* packet) {
  return layout.type_bits == 8 ? load<std::uint8_t>(packet) : load<std::uint16_t>(packet);
}

std::uint32_t init_id_of(const HeaderLayout& layout, const std::byte* packet) {
  return load<std::uint32_t>(packet + layout.init_id_offset) & 0xFF'FFFFU;
}

std::uint64_t serial_number_of(const HeaderLayout& layout, const std::byte* packet) {
  return load<std::uint64_t>(packet + layout.serial_number_offset) & 0xFF'FFFF'FFFFU;
}

}  // namespace

std::optional<PacketHeader> recognise_header(std::span<const std::byte> packet,
                                             std::uint64_t serial_number, std::uint32_t init_id) {
  if (packet.size() < kHeaderBytes || (serial_number == 0 && init_id == 0)) return std::nullopt;
  const auto fits = [&](const HeaderLayout& layout) {
    return type_of(layout, packet.data()) == kLidarPacketType &&
           (serial_number == 0 || serial_number_of(layout, packet.data()) == serial_number) &&
           (serial_number != 0 || init_id_of(layout, packet.data()) == init_id);
  };
  const bool standard = fits(kStandardHeader);
  const bool fusa = fits(kFusaHeader);
  if (standard == fusa) return std::nullopt;
  return standard ? PacketHeader::kStandard : PacketHeader::kFusa;
}

std::optional<PacketView> PacketView::parse(const PacketFormat& format,
                                            std::span<const std::byte> bytes, PacketError* error) {
  if (bytes.size() != format.packet_bytes) return refuse(PacketError::kSize, error);
  if (!format.legacy() && type_of(layout_of(format), bytes.data()) != kLidarPacketType) {
    return refuse(PacketError::kType, error);
  }
  if (error != nullptr) *error = PacketError::kNone;
  return PacketView(format, bytes);
}

std::uint32_t PacketView::frame_id() const {
  if (format_->legacy()) return column(0).legacy_frame_id();
  const std::byte* at = bytes_.data() + layout_of(*format_).frame_id_offset;
  return format_->frame_id_bits() == 32 ? load<std::uint32_t>(at) : load<std::uint16_t>(at);
}

std::uint32_t PacketView::init_id() const {
  return format_->legacy() ? 0 : init_id_of(layout_of(*format_), bytes_.data());
}

std::uint64_t PacketView::serial_number() const {
  return format_->legacy() ? 0 : serial_number_of(layout_of(*format_), bytes_.data());
}

PacketHealth PacketView::health() const {
  if (format_->legacy()) return {};
  const auto byte = [&](int offset) { return load<std::uint8_t>(bytes_.data() + offset); };
  constexpr unsigned kState = 0x0FU;
  return {byte(layout_of(*format_).alert_flags_offset), byte(kThermalCountdownOffset),
          byte(kShotLimitingCountdownOffset),
          static_cast<std::uint8_t>(byte(kThermalStateOffset) & kState),
          static_cast<std::uint8_t>(byte(kShotLimitingStateOffset) & kState)};
}

bool PacketView::crc_matches() const {
  if (format_->legacy()) return false;
  const auto covered = bytes_.first(bytes_.size() - kPacketCrcBytes);
  return crc64(covered) == load<std::uint64_t>(covered.data() + covered.size());
}

ColumnView PacketView::column(int index) const {
  const auto offset = static_cast<std::size_t>(format_->layout->packet_header_bytes) +
                      static_cast<std::size_t>(index) * format_->column_bytes;
  return {*format_, bytes_.data() + offset};
}

}  // namespace glint
