// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>
#include <string_view>

namespace glint {

/// What the stamps of a sensor's packets, and so the times of poses, are taken from.
enum class ClockSource {
  kInternal,  ///< The sensor's own oscillator, which starts near 0 when it is switched on.
  kPps,       ///< Set by pulses and NMEA sentences, of GNSS for example.
  kPtp,       ///< Set over the network by IEEE 1588, in TAI unless the network says otherwise.
  kHost,      ///< This machine's clock: the sensor's stamps converted by the clock model.
};

/// "internal", "pps", "ptp" or "host".
std::string_view to_string(ClockSource source);
/// The source of that name; null for any other.
std::optional<ClockSource> parse_clock_source(std::string_view name);
/// The source that the sensor's setting `timestamp_mode` stands for, e.g. "TIME_FROM_PTP_1588";
/// null for one that is not known.
std::optional<ClockSource> clock_of_timestamp_mode(std::string_view mode);
/// The other way; the mode of the oscillator for the host's clock, which no sensor knows.
std::string_view to_timestamp_mode(ClockSource source);

}  // namespace glint
