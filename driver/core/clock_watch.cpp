// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/clock_watch.hpp"

#include <cmath>
#include <cstdlib>

namespace glint {
namespace {

bool valid(const LidarScan& scan, int column) {
  return (scan.column_status[static_cast<std::size_t>(column)] & 1U) != 0;
}

SensorTime& time_of(LidarScan& scan, int column) {
  return scan.column_time[static_cast<std::size_t>(column)];
}

}  // namespace

// How much more time than expected passed over so many columns; 0 if that is no jump. Over a gap
// the rate, which the metadata may have wrong, makes a difference of its own.
std::int64_t ClockWatch::jump_ns(std::int64_t columns, int columns_per_scan,
                                 std::int64_t elapsed_ns) const {
  const double per_column_ns = static_cast<double>(scan_period_ns_) / columns_per_scan;
  const std::int64_t expected_ns = std::llround(static_cast<double>(columns) * per_column_ns);
  const std::int64_t excess_ns = elapsed_ns - expected_ns;
  return std::abs(excess_ns) > scan_period_ns_ / 2 + expected_ns / 4 ? excess_ns : 0;
}

bool ClockWatch::jumped(LidarScan& scan) {
  const auto columns = static_cast<int>(scan.column_time.size());
  int first = 0;
  while (first < columns && !valid(scan, first)) ++first;
  if (first == columns) return false;
  int last = columns - 1;
  while (!valid(scan, last)) --last;

  bool jumped = mend(scan, first, last);
  const std::int64_t base = static_cast<std::int64_t>(scan.sequence) * columns;
  if (started_) {
    const std::int64_t elapsed_ns = time_of(scan, first) - time_;
    jumped = jump_ns(base + first - column_, columns, elapsed_ns) != 0 || jumped;
  }
  started_ = true;
  column_ = base + last;
  time_ = time_of(scan, last);
  return jumped;
}

// Whether there was a jump inside. One to and fro is none: damaged times between good ones.
bool ClockWatch::mend(LidarScan& scan, int first, int last) const {
  const auto columns = static_cast<int>(scan.column_time.size());
  const std::int64_t elapsed_ns = time_of(scan, last) - time_of(scan, first);
  const std::int64_t expected_ns = scan_period_ns_ * (last - first) / columns;
  if (std::abs(elapsed_ns - expected_ns) <= scan_period_ns_ / 2) return false;

  // Calls fn(column, sum of the jumps behind it) from the last to the first.
  const auto for_each_column = [&](auto fn) {
    std::int64_t sum_ns = 0;
    int behind = last;
    SensorTime time_behind = time_of(scan, last);
    for (int m = last; m >= first; --m) {
      if (!valid(scan, m)) continue;
      const SensorTime time = time_of(scan, m);
      sum_ns += jump_ns(behind - m, columns, time_behind - time);
      behind = m;
      time_behind = time;
      fn(m, sum_ns);
    }
    return sum_ns;
  };
  if (std::abs(for_each_column([](int, std::int64_t) {})) <= scan_period_ns_ / 2) return false;
  for_each_column([&](int m, std::int64_t sum_ns) { time_of(scan, m).ns += sum_ns; });
  return true;
}

}  // namespace glint
