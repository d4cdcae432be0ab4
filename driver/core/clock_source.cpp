// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/clock_source.hpp"

#include <algorithm>
#include <array>

namespace glint {
namespace {

struct Row {
  ClockSource source;
  std::string_view name;
  std::string_view timestamp_mode;
};

// The first row of a mode is the source it stands for.
constexpr std::array kRows{Row{ClockSource::kInternal, "internal", "TIME_FROM_INTERNAL_OSC"},
                           Row{ClockSource::kPps, "pps", "TIME_FROM_SYNC_PULSE_IN"},
                           Row{ClockSource::kPtp, "ptp", "TIME_FROM_PTP_1588"},
                           Row{ClockSource::kHost, "host", "TIME_FROM_INTERNAL_OSC"}};

template <class Field>
std::optional<ClockSource> find(std::string_view text, Field field) {
  const auto* row = std::ranges::find(kRows, text, field);
  return row == kRows.end() ? std::nullopt : std::optional(row->source);
}

}  // namespace

std::string_view to_string(ClockSource source) {
  return kRows[static_cast<std::size_t>(source)].name;
}

std::optional<ClockSource> parse_clock_source(std::string_view name) {
  return find(name, &Row::name);
}

std::optional<ClockSource> clock_of_timestamp_mode(std::string_view mode) {
  return find(mode, &Row::timestamp_mode);
}

std::string_view to_timestamp_mode(ClockSource source) {
  return kRows[static_cast<std::size_t>(source)].timestamp_mode;
}

}  // namespace glint
