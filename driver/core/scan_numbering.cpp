// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/scan_numbering.hpp"

#include <algorithm>

namespace glint {
namespace {

// Legacy packets, which have no init id, may be this many scans late and yet be of this count.
constexpr std::int64_t kOldestLate_scans = 16;
// So far ahead whatever the time.
constexpr std::int64_t kFarthestAhead_scans = 4;
// A damaged frame id comes alone, or twice where packets are doubled.
constexpr int kStraysThatBegin = 3;
// Late packets and nothing else: one scan's, but no fewer than a burst of duplicates may be.
constexpr int kFewestLateThatBegin = 16;

}  // namespace

ScanNumbering::ScanNumbering(const PacketFormat& format, int packets_per_scan,
                             std::int64_t scan_period_ns)
    : format_(format),
      late_that_begin_(std::max(packets_per_scan, kFewestLateThatBegin)),
      scan_period_ns_(scan_period_ns) {}

// Half the range of ids that wrap tells older from newer.
std::int64_t ScanNumbering::difference(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t ahead = a - b;
  return format_.frame_id_bits() == 16 ? std::int64_t{static_cast<std::int16_t>(ahead)}
                                       : std::int64_t{static_cast<std::int32_t>(ahead)};
}

std::int64_t ScanNumbering::sequence(std::uint32_t frame_id) const {
  if (started_) return newest_ + difference(frame_id, newest_frame_id_);
  return newest_ < 0 ? frame_id : newest_ + 1;
}

ScanNumbering::Fit ScanNumbering::fit(std::uint32_t frame_id, SensorTime time, bool too_old) {
  if (!started_) return Fit::kFits;
  const std::int64_t number = sequence(frame_id);
  const bool falls_back = format_.legacy() && number < newest_ - kOldestLate_scans;
  if (falls_back || leaps(number - newest_, time)) return stray(frame_id);
  return number <= left_ || too_old ? late() : Fit::kFits;
}

ScanNumbering::Fit ScanNumbering::late() {
  return ++late_in_a_row_ < late_that_begin_ ? Fit::kLate : Fit::kBegunAnew;
}

// Whether a scan would lie further ahead than the time since the newest allows: a damaged frame id
// must not make everything after it late.
bool ScanNumbering::leaps(std::int64_t scans_ahead, SensorTime time) const {
  // The rate in the metadata may be off by a factor of two.
  return scans_ahead > kFarthestAhead_scans &&
         time - newest_time_ < scans_ahead * scan_period_ns_ / 4;
}

ScanNumbering::Fit ScanNumbering::stray(std::uint32_t frame_id) {
  const std::int64_t ahead = difference(frame_id, stray_frame_id_);
  const bool goes_on = strays_in_a_row_ > 0 && (ahead == 0 || ahead == 1);
  strays_in_a_row_ = goes_on ? strays_in_a_row_ + 1 : 1;
  stray_frame_id_ = frame_id;
  return strays_in_a_row_ < kStraysThatBegin ? Fit::kStray : Fit::kBegunAnew;
}

void ScanNumbering::scan_opened(std::uint32_t frame_id, SensorTime time) {
  const std::int64_t number = sequence(frame_id);
  if (number > newest_) {
    newest_ = number;
    newest_frame_id_ = frame_id;
    newest_time_ = time;
  }
  started_ = true;
}

void ScanNumbering::begin_anew() {
  left_ = newest_;
  started_ = false;
  fitted();
}

void ScanNumbering::begin_after(const ScanNumbering& other) {
  newest_ = other.newest_;
  begin_anew();
}

}  // namespace glint
