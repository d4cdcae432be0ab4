// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_view.hpp"

#include <algorithm>

#include "driver/core/bytes.hpp"
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
  return {static_cast<std::int64_t>(
      std::min(load<std::uint64_t>(data_ + kColumnTimeOffset), kLatest_ns))};
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

std::optional<PacketView> PacketView::parse(const PacketFormat& format,
                                            std::span<const std::byte> bytes, PacketError* error) {
  if (bytes.size() != format.packet_bytes) return refuse(PacketError::kSize, error);
  if (!format.legacy() &&
      load<std::uint16_t>(bytes.data() + kPacketTypeOffset) != kLidarPacketType) {
    return refuse(PacketError::kType, error);
  }
  if (error != nullptr) *error = PacketError::kNone;
  return PacketView(format, bytes);
}

std::uint16_t PacketView::frame_id() const {
  if (format_->legacy()) return column(0).legacy_frame_id();
  return load<std::uint16_t>(bytes_.data() + kFrameIdOffset);
}

std::uint32_t PacketView::init_id() const {
  if (format_->legacy()) return 0;
  return load<std::uint32_t>(bytes_.data() + kInitIdOffset) & 0xFF'FFFFU;
}

std::uint64_t PacketView::serial_number() const {
  if (format_->legacy()) return 0;
  return load<std::uint64_t>(bytes_.data() + kSerialNumberOffset) & 0xFF'FFFF'FFFFU;
}

ColumnView PacketView::column(int index) const {
  const auto offset = static_cast<std::size_t>(format_->layout->packet_header_bytes) +
                      static_cast<std::size_t>(index) * format_->column_bytes;
  return {*format_, bytes_.data() + offset};
}

}  // namespace glint
