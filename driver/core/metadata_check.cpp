// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/metadata_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace glint {
namespace {

/// Columns that came in none of so many scans are columns that there are not; the last scan may be
/// cut off.
constexpr std::uint64_t kEnoughFrames = 3;

std::uint64_t as_number(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end ? number : 0;
}

std::string other_sensor(const SensorInfo& info, const PacketEvidence& seen,
                         std::string_view packets) {
  const std::uint64_t serial = as_number(info.serial_number);
  if (serial == 0 || seen.serial_number == 0 || seen.serial_number == serial) return {};
  return fmt::format(
      "{} come from sensor {}, but the metadata is that of sensor {}; give the metadata recorded "
      "with them.",
      packets, seen.serial_number, serial);
}

std::string other_start(const SensorInfo& info, const PacketEvidence& seen,
                        std::string_view packets) {
  if (info.init_id == 0 || seen.init_ids.front() == 0) return {};
  if (std::ranges::find(seen.init_ids, info.init_id) != seen.init_ids.end()) return {};
  return fmt::format(
      "{} carry initialization id {}, but the metadata has {}: it was read before or after another "
      "start of the sensor, maybe with other settings; give the metadata recorded with them, or, "
      "if no setting changed, take initialization_id out of it.",
      packets, seen.init_ids.front(), info.init_id);
}

std::string other_columns(const SensorInfo& info, const PacketEvidence& seen,
                          std::string_view packets) {
  const auto [first, last] = info.column_window;
  const int last_expected = first > last ? info.columns_per_frame - 1 : last;
  const bool too_many = seen.last_column >= info.columns_per_frame;
  // Other modes have half as many columns; a quarter missing each time is no loss on the way.
  const bool too_few =
      seen.frames >= kEnoughFrames && 4 * (seen.last_column + 1) <= 3 * (last_expected + 1);
  if (!too_many && !too_few) return {};
  return fmt::format(
      "{} have columns up to {}, but the metadata has {} columns a scan with a window that ends at "
      "{}; give the metadata recorded with them.",
      packets, seen.last_column, info.columns_per_frame, last_expected);
}

/// Whether a packet's columns are neighbours, as a sensor sends them: damaged ones prove nothing.
bool is_in_order(const PacketView& packet) {
  const int first = packet.column(0).measurement_id();
  for (int i = 1; i < packet.column_count(); ++i) {
    if (packet.column(i).measurement_id() != first + i) return false;
  }
  return true;
}

}  // namespace

void PacketEvidence::add(const PacketView& packet) {
  if (!is_in_order(packet)) return;
  if (serial_number == 0) serial_number = packet.serial_number();
  const std::uint32_t init_id = packet.init_id();
  auto* const place = std::ranges::find_if(
      init_ids, [&](std::uint32_t known) { return known == init_id || known == 0; });
  if (place != init_ids.end()) *place = init_id;
  if (last_column < 0 || packet.frame_id() != frame_id) ++frames;
  frame_id = packet.frame_id();
  last_column =
      std::max<int>(last_column, packet.column(packet.column_count() - 1).measurement_id());
}

std::string metadata_contradiction(const SensorInfo& info, const PacketEvidence& evidence,
                                   std::string_view packets) {
  for (const auto& find : {other_sensor, other_start, other_columns}) {
    if (std::string sentence = find(info, evidence, packets); !sentence.empty()) return sentence;
  }
  return {};
}

}  // namespace glint
