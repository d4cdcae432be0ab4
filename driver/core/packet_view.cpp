// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_view.hpp"

#include "driver/core/bytes.hpp"
#include "driver/core/packet_fields.hpp"

namespace glint {
namespace {

std::optional<PacketView> refuse(PacketError why, PacketError* error) {
  if (error != nullptr) *error = why;
  return std::nullopt;
}

}  // namespace

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

const HeaderLayout& layout_of(const PacketFormat& format) { return header_layout(format.header); }

}  // namespace

std::optional<PacketHeader> recognise_header(std::span<const std::byte> packet,
                                             std::uint64_t serial_number, std::uint32_t init_id,
                                             std::uint16_t type) {
  if (packet.size() < kPacketHeaderBytes || (serial_number == 0 && init_id == 0))
    return std::nullopt;
  const auto fits = [&](const HeaderLayout& layout) {
    if (packet_type(layout, packet.data()) != type) return false;
    return serial_number != 0 ? packet_serial_number(layout, packet.data()) == serial_number
                              : packet_init_id(layout, packet.data()) == init_id;
  };
  const bool standard = fits(kStandardHeader);
  const bool fusa = fits(kFusaHeader);
  if (standard == fusa) return std::nullopt;
  return standard ? PacketHeader::kStandard : PacketHeader::kFusa;
}

std::optional<PacketView> PacketView::parse(const PacketFormat& format,
                                            std::span<const std::byte> bytes, PacketError* error) {
  if (bytes.size() != format.packet_bytes) return refuse(PacketError::kSize, error);
  if (!format.legacy() && packet_type(layout_of(format), bytes.data()) != kLidarPacketType) {
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
  return format_->legacy() ? 0 : packet_init_id(layout_of(*format_), bytes_.data());
}

std::uint64_t PacketView::serial_number() const {
  return format_->legacy() ? 0 : packet_serial_number(layout_of(*format_), bytes_.data());
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

bool PacketView::crc_matches() const { return !format_->legacy() && packet_crc_matches(bytes_); }

}  // namespace glint
