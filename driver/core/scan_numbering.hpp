// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "driver/core/packet_format.hpp"
#include "driver/core/time.hpp"

namespace glint {

/// Numbers the scans of a stream by their frame ids, which wrap and may begin anew, and tells ids
/// that do not fit. Thread-compatible.
class ScanNumbering {
 public:
  enum class Fit {
    kFits,
    kLate,      ///< Of a scan that left.
    kStray,     ///< Far from the scans before: damaged, or the first of a new count.
    kBegunAnew  ///< The ids have begun anew: call begin_anew(), and the packet fits.
  };

  /// `format` is looked at again and again, for packets may prove another width of frame ids.
  ScanNumbering(const PacketFormat& format, int packets_per_scan, std::int64_t scan_period_ns);

  /// The number of the scan with this frame id.
  [[nodiscard]] std::int64_t sequence(std::uint32_t frame_id) const;
  /// Whether a packet with this frame id and time, of no open scan, may open one. `too_old`: newer
  /// scans have left no room for it.
  Fit fit(std::uint32_t frame_id, SensorTime time, bool too_old);
  /// A packet is late by other evidence: kLate or kBegunAnew.
  Fit late();
  /// A packet fitted.
  void fitted() { late_in_a_row_ = strays_in_a_row_ = 0; }
  void scan_opened(std::uint32_t frame_id, SensorTime time);
  void scan_left(std::int64_t sequence) { left_ = sequence; }
  /// The next frame id is that of the next scan, whatever it is.
  void begin_anew();
  /// The same, after the scans of another stream.
  void begin_after(const ScanNumbering& other);

 private:
  [[nodiscard]] std::int64_t difference(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] bool leaps(std::int64_t scans_ahead, SensorTime time) const;
  Fit stray(std::uint32_t frame_id);

  const PacketFormat& format_;
  const int late_that_begin_;
  const std::int64_t scan_period_ns_;

  bool started_ = false;               // a scan was opened since the start or the last begin
  std::uint32_t newest_frame_id_ = 0;  // of the newest scan ever opened, and its
  std::int64_t newest_ = -1;           // number
  SensorTime newest_time_;             // and time
  std::int64_t left_ = -1;             // of the newest scan that left
  int late_in_a_row_ = 0;
  int strays_in_a_row_ = 0;  // each of the scan of the one before, or of the next
  std::uint32_t stray_frame_id_ = 0;
};

}  // namespace glint
