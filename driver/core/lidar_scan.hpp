// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/packet_format.hpp"
#include "driver/core/time.hpp"

namespace glint {

/// An H x W array of pixels, row-major. Whether it is staggered (as measured: column index is the
/// measurement id) or destaggered (rows shifted so that columns look the same way) is said by
/// owner.
template <class T>
struct Image {
  int rows = 0;
  int cols = 0;
  std::vector<T> data;

  Image() = default;
  Image(int r, int c)
      : rows(r), cols(c), data(static_cast<std::size_t>(r) * static_cast<std::size_t>(c)) {}
  [[nodiscard]] bool empty() const { return data.empty(); }
  [[nodiscard]] std::size_t index(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) +
           static_cast<std::size_t>(c);
  }
  T& operator()(int r, int c) { return data[index(r, c)]; }
  const T& operator()(int r, int c) const { return data[index(r, c)]; }
  [[nodiscard]] std::span<T> row(int r) {
    return {&data[index(r, 0)], static_cast<std::size_t>(cols)};
  }
  [[nodiscard]] std::span<const T> row(int r) const {
    return {&data[index(r, 0)], static_cast<std::size_t>(cols)};
  }
};

/// One revolution of the sensor, STAGGERED: column m of every image was measured at column_time[m].
/// Columns that never came or were invalid are zero in pixels and time; those that never came also
/// in status. Images of channels that the profile lacks are empty. Value type.
struct LidarScan {
  LidarScan() = default;
  /// Allocates every image that the format's profile carries.
  explicit LidarScan(const PacketFormat& format);

  std::uint32_t frame_id = 0;     ///< As on the wire: 16 bits wide, or 32 with a FUSA header.
  std::uint64_t sequence = 0;     ///< Frame id unwrapped since the assembler started, never falls.
  bool sensor_restarted = false;  ///< First scan after the sensor restarted (new init id).
  /// The sensor's clock jumped by more than half a scan period since the end of the scan before.
  /// In the middle of this one, maybe: columns before the jump have their times moved to the clock
  /// after it.
  bool clock_jumped = false;
  Image<std::uint32_t> range_mm;      ///< 0 = no return.
  Image<std::uint16_t> signal;        ///< Photons.
  Image<std::uint16_t> reflectivity;  ///< 16-bit on old legacy firmware, calibrated 0-255 later.
  Image<std::uint16_t> near_ir;       ///< Photons of ambient light.
  Image<std::uint32_t> range2_mm;     ///< Second return, dual profiles only.
  Image<std::uint16_t> signal2;
  Image<std::uint16_t> reflectivity2;
  std::vector<SensorTime> column_time;       ///< W entries.
  std::vector<std::uint32_t> column_status;  ///< W entries, status word as on the wire.
  int columns_expected = 0;                  ///< Columns inside the azimuth window.
  int columns_received = 0;                  ///< Valid columns inside the azimuth window that came.

  /// Time of the nominal last column of the azimuth window, and of its middle one. Where that
  /// column was lost it is extrapolated from those received, so loss does not move it.
  SensorTime end_time;
  SensorTime mid_time;

  [[nodiscard]] double completeness() const {
    return columns_expected > 0 ? static_cast<double>(columns_received) / columns_expected : 0.0;
  }
};

}  // namespace glint
