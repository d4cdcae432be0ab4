// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/arrival_ledger.hpp"

#include <algorithm>

namespace glint {
namespace {

// Whether a packet of a scan came; all but damaged packets set the flags of all their columns.
bool came(const OpenScan& scan, int packet, int columns) {
  const auto begin = scan.arrived.begin() + static_cast<std::ptrdiff_t>(packet) * columns;
  return std::any_of(begin, begin + columns, [](std::uint8_t flag) { return flag != 0; });
}

}  // namespace

std::uint64_t ArrivalLedger::missing(const OpenScan& scan, bool newest) {
  const auto packets = static_cast<int>(window_.packet_expected.size());
  const auto expected = [&](int begin, int end) {
    return std::count(window_.packet_expected.begin() + begin,
                      window_.packet_expected.begin() + end, std::uint8_t{1});
  };
  std::int64_t count = 0;
  int begin = 0;
  int end = packets;
  if (started_) {
    count += expected(packet_, packets) + (scan.sequence - sequence_ - 1) * window_.packets;
  } else {
    while (begin < packets && !came(scan, begin, columns_per_packet_)) ++begin;
  }
  if (newest) {
    while (end > begin && !came(scan, end - 1, columns_per_packet_)) --end;
  }
  if (scan.expected_arrived < window_.count) {
    for (int i = begin; i < end; ++i) {
      const bool is_expected = window_.packet_expected[static_cast<std::size_t>(i)] != 0;
      if (is_expected && !came(scan, i, columns_per_packet_)) ++count;
    }
  }
  started_ = true;
  sequence_ = scan.sequence;
  packet_ = end;
  return static_cast<std::uint64_t>(count);
}

}  // namespace glint
