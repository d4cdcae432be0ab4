// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/flat_table.hpp"

#include <algorithm>

namespace glint::recording {

std::optional<FlatTable> FlatTable::root(ByteSpan sized_buffer, std::string_view identifier) {
  ByteReader reader(sized_buffer);
  const ByteSpan buffer = reader.bytes(reader.integer<std::uint32_t>());
  ByteReader start(buffer);
  const auto at = start.integer<std::uint32_t>();
  if (start.text(4) != identifier) return std::nullopt;
  return FlatTable(buffer, at);
}

ByteReader FlatTable::reader_at(std::uint64_t position) const {
  return ByteReader(buffer_.subspan(std::min<std::uint64_t>(position, buffer_.size())));
}

std::optional<std::uint64_t> FlatTable::position_of(int field) const {
  ByteReader table = reader_at(at_);
  // Signed, counted backwards from the table; as wrapping arithmetic it is the same either way.
  const std::uint64_t fields_at = static_cast<std::uint32_t>(at_) - table.integer<std::uint32_t>();
  ByteReader fields = reader_at(fields_at);
  const std::uint64_t entry = 4 + 2 * static_cast<std::uint64_t>(field);
  const auto fields_bytes = fields.integer<std::uint16_t>();
  const std::uint16_t offset = reader_at(fields_at + entry).integer<std::uint16_t>();
  if (!table.ok() || !fields.ok() || entry + 2 > fields_bytes || offset == 0) return std::nullopt;
  return at_ + offset;
}

std::optional<std::uint64_t> FlatTable::u64(int field) const {
  const std::optional<std::uint64_t> position = position_of(field);
  if (!position) return std::nullopt;
  ByteReader reader = reader_at(*position);
  const auto value = reader.integer<std::uint64_t>();
  return reader.ok() ? std::optional(value) : std::nullopt;
}

std::optional<std::uint64_t> FlatTable::vector_of(int field) const {
  const std::optional<std::uint64_t> position = position_of(field);
  if (!position) return std::nullopt;
  ByteReader reader = reader_at(*position);
  const auto offset = reader.integer<std::uint32_t>();
  return reader.ok() ? std::optional(*position + offset) : std::nullopt;
}

ByteSpan FlatTable::bytes(int field) const {
  const std::optional<std::uint64_t> vector = vector_of(field);
  if (!vector) return {};
  ByteReader reader = reader_at(*vector);
  return reader.bytes(reader.integer<std::uint32_t>());
}

std::optional<FlatTable> FlatTable::table(int field, std::uint32_t index) const {
  const std::optional<std::uint64_t> vector = vector_of(field);
  if (!vector || index >= reader_at(*vector).integer<std::uint32_t>()) return std::nullopt;
  const std::uint64_t entry = *vector + 4 + std::uint64_t{4} * index;
  ByteReader reader = reader_at(entry);
  const auto offset = reader.integer<std::uint32_t>();
  if (!reader.ok()) return std::nullopt;
  return FlatTable(buffer_, entry + offset);
}

}  // namespace glint::recording
