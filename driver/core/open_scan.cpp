// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/open_scan.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double kLongestStep_ns = 10e9;

bool valid(const LidarScan& scan, int column) {
  return (scan.column_status[static_cast<std::size_t>(column)] & 1U) != 0;
}

template <class T>
void zero_columns(Image<T>& image, int begin, int end) {
  if (image.empty()) return;
  for (int r = 0; r < image.rows; ++r) {
    const auto row = image.row(r);
    std::fill(row.begin() + begin, row.begin() + end, T{});
  }
}

void zero_pixels(LidarScan& scan, int begin, int end) {
  zero_columns(scan.range_mm, begin, end);
  zero_columns(scan.signal, begin, end);
  zero_columns(scan.reflectivity, begin, end);
  zero_columns(scan.near_ir, begin, end);
  zero_columns(scan.range2_mm, begin, end);
  zero_columns(scan.signal2, begin, end);
  zero_columns(scan.reflectivity2, begin, end);
}

// The nearest valid column from `column` on in steps of `step`; -1 when there is none.
int nearest_valid(const LidarScan& scan, int column, int step) {
  const int columns = static_cast<int>(scan.column_status.size());
  for (int m = column; m >= 0 && m < columns; m += step) {
    if (valid(scan, m)) return m;
  }
  return -1;
}

double mean_spacing_ns(const LidarScan& scan, int first, int last) {
  const auto time = [&](int m) { return scan.column_time[static_cast<std::size_t>(m)]; };
  return static_cast<double>(time(last) - time(first)) / (last - first);
}

// Time between two columns: measured where a fair part of the revolution came, for over a few
// columns the jitter of single ones (5 %) would tell more than the rate; else the nominal one.
double column_spacing_ns(const LidarScan& scan, std::int64_t scan_period_ns) {
  const int columns = static_cast<int>(scan.column_status.size());
  const int first = nearest_valid(scan, 0, 1);
  const int last = nearest_valid(scan, columns - 1, -1);
  if (last - first >= columns / 4) return mean_spacing_ns(scan, first, last);
  return static_cast<double>(scan_period_ns) / columns;
}

}  // namespace

ColumnWindow::ColumnWindow(const SensorInfo& info)
    : expected(static_cast<std::size_t>(info.columns_per_frame)),
      packet_expected(expected.size() / static_cast<std::size_t>(info.columns_per_packet)) {
  const auto [first, final] = info.column_window;
  const bool wraps = first > final;
  for (int m = 0; m < info.columns_per_frame; ++m) {
    const bool inside = wraps ? m >= first || m <= final : m >= first && m <= final;
    expected[static_cast<std::size_t>(m)] = inside ? 1 : 0;
    if (!inside) continue;
    ++count;
    last = m;
    packet_expected[static_cast<std::size_t>(m / info.columns_per_packet)] = 1;
  }
  packets = static_cast<int>(std::ranges::count(packet_expected, std::uint8_t{1}));
  for (int m = 0, seen = 0; m < info.columns_per_frame; ++m) {
    if (expected[static_cast<std::size_t>(m)] == 0 || ++seen <= count / 2) continue;
    middle = m;
    break;
  }
}

void OpenScan::start(std::uint32_t frame_id, std::int64_t unwrapped_id, std::int64_t position) {
  scan.frame_id = frame_id;
  scan.sequence = static_cast<std::uint64_t>(unwrapped_id);
  scan.sensor_restarted = false;
  scan.columns_received = 0;
  std::ranges::fill(arrived, std::uint8_t{0});
  std::ranges::fill(scan.column_status, 0U);
  expected_arrived = 0;
  newer_packets = 0;
  sequence = unwrapped_id;
  opened_at = position;
}

void OpenScan::finish(const ColumnWindow& window, std::int64_t scan_period_ns, ClockWatch& clock) {
  const int columns = static_cast<int>(arrived.size());
  for (int begin = 0; begin < columns;) {
    if (valid(scan, begin)) {
      ++begin;
      continue;
    }
    int end = begin;
    for (; end < columns && !valid(scan, end); ++end) {
      scan.column_time[static_cast<std::size_t>(end)] = {};
    }
    zero_pixels(scan, begin, end);
    begin = end;
  }
  scan.columns_expected = window.count;
  scan.clock_jumped = clock.jumped(scan);
  scan.end_time = estimate_column_time(scan, window.last, scan_period_ns);
  scan.mid_time = estimate_column_time(scan, window.middle, scan_period_ns);
}

SensorTime estimate_column_time(const LidarScan& scan, int column, std::int64_t scan_period_ns) {
  const auto time = [&](int m) { return scan.column_time[static_cast<std::size_t>(m)]; };
  const int before = nearest_valid(scan, column, -1);
  const int after = nearest_valid(scan, column, 1);
  if (before < 0 && after < 0) return {};
  if (before == column) return time(column);
  const double spacing_ns = before >= 0 && after >= 0 ? mean_spacing_ns(scan, before, after)
                                                      : column_spacing_ns(scan, scan_period_ns);
  const int from = before >= 0 ? before : after;
  // A damaged time may lie years off; the estimate stays near its anchor all the same.
  const double step_ns =
      std::clamp(spacing_ns * (column - from), -kLongestStep_ns, kLongestStep_ns);
  return time(from) + std::llround(step_ns);
}

}  // namespace glint
