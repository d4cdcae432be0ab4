// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/timing.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

constexpr std::int64_t kClockStartNs = 1'000 * kNsPerSecond;
// The motor's speed swings by these shares, over so many revolutions.
struct Swing {
  double share;
  double revolutions;
};
constexpr std::array<Swing, 2> kSwings = {{{0.002, 5.3}, {0.003, 0.97}}};
// Quartzes keep within some 20 ppm; how far they stray while they warm up, and for how long.
constexpr double kOffsetPpm = 10.0;
constexpr double kWarmUpPpm = 3.0;
constexpr double kWarmUpS = 600.0;

}  // namespace

Timing::Timing(const SensorInfo& info, std::uint64_t seed)
    : period_s_(1.0 / info.scan_rate_hz), columns_(info.columns_per_frame) {
  // When the sensor was switched on does not fall on a whole second.
  Random random{seed, 0xC10CULL};
  start_ = {kClockStartNs + random.below(static_cast<int>(kNsPerSecond))};
  offset_ppm_ = kOffsetPpm * random.gaussian();
  warm_up_ppm_ = kWarmUpPpm * random.gaussian();
}

double Timing::column_s(std::int64_t column) const {
  const double revolutions = static_cast<double>(column) / columns_;
  double turned = revolutions;
  for (const Swing& swing : kSwings) {
    const double rate = 2.0 * std::numbers::pi / swing.revolutions;
    turned += swing.share / rate * std::sin(rate * revolutions);
  }
  return period_s_ * turned;
}

double Timing::clock_rate_error(double true_s) const {
  return 1e-6 * (offset_ppm_ + warm_up_ppm_ * (1.0 - std::exp(-std::max(0.0, true_s) / kWarmUpS)));
}

SensorTime Timing::clock_at(double true_s) const {
  // The integral of the rate error.
  const double warm_s =
      true_s < 0.0 ? 0.0 : true_s - kWarmUpS * (1.0 - std::exp(-true_s / kWarmUpS));
  const double error_s = 1e-6 * (offset_ppm_ * true_s + warm_up_ppm_ * warm_s);
  return start_ + std::llround(1e9 * (true_s + error_s));
}

double Timing::true_s(SensorTime time) const {
  const double shown_s = static_cast<double>(time - start_) * kSecondsPerNs;
  double true_s = shown_s;
  // The error changes by parts in a hundred thousand: two rounds reach its nanosecond.
  for (int i = 0; i < 2; ++i) {
    true_s -= static_cast<double>(clock_at(true_s) - time) * kSecondsPerNs;
  }
  return true_s;
}

}  // namespace glint::synth
