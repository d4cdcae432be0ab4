// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/clock_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glint {
namespace {

// Packets that must agree on a jump: one with a damaged time is none.
constexpr int kConfirmations = 8;
// Packets that are late by more than the threshold for so long are not late, the host's clock is.
constexpr std::int64_t kLongestDelay_ns = 1'000'000'000;
// Fewer packets do not make a model that could be contradicted: the first one may be very late.
constexpr std::uint64_t kSettled = 64;

using Limits = std::numeric_limits<std::int64_t>;

std::int64_t saturating_add(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  if (__builtin_add_overflow(a, b, &sum)) return b > 0 ? Limits::max() : Limits::min();
  return sum;
}

std::int64_t saturating_subtract(std::int64_t a, std::int64_t b) {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(a, b, &difference)) return b < 0 ? Limits::max() : Limits::min();
  return difference;
}

std::int64_t rounded(double value) {
  constexpr double kMost = 4e18;
  return std::llround(std::clamp(value, -kMost, kMost));
}

// A quarter of the range of 64 bits: differences of what lies within it do not overflow.
constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 61;

std::int64_t magnitude(std::int64_t value) {
  return value == Limits::min() ? Limits::max() : std::abs(value);
}

}  // namespace

std::optional<ClockJump> ClockModel::add(SensorTime sensor, HostTime host) {
  if (host.ns <= 0) return std::nullopt;
  const std::int64_t offset_ns = saturating_subtract(host.ns, sensor.ns);
  if (!anchored_) {
    anchor(sensor, offset_ns);
    return std::nullopt;
  }
  const std::int64_t residual_ns = saturating_subtract(offset_ns, predicted_offset_ns(sensor));
  if (magnitude(residual_ns) <= threshold_ns_) {
    candidate_ = {};
    accept(sensor, offset_ns);
    return std::nullopt;
  }
  collect(sensor, host, offset_ns, residual_ns);
  if (!confirmed(host)) return std::nullopt;
  const bool settled = envelope_.points() >= kSettled;
  const ClockJump jump{saturating_subtract(candidate_.offset_ns, predicted_offset_ns(newest_)),
                       candidate_.offset_ns};
  anchor(candidate_.sensor, candidate_.offset_ns);
  if (!settled) return std::nullopt;
  ++jumps_;
  return jump;
}

std::optional<HostTime> ClockModel::to_host(SensorTime sensor) const {
  if (!anchored_) return std::nullopt;
  return HostTime{saturating_add(sensor.ns, predicted_offset_ns(sensor))};
}

ClockStatus ClockModel::status() const {
  if (!anchored_) return {};
  ClockStatus status;
  status.known = true;
  status.offset_ns = predicted_offset_ns(newest_);
  status.skew_ppm = envelope_.slope() * 1e6;
  // While packets contradict the model, either may be right.
  status.sigma_ns = std::max(rounded(envelope_.sigma_ns()), magnitude(candidate_.residual_ns));
  status.jumps = jumps_;
  return status;
}

std::int64_t ClockModel::predicted_offset_ns(SensorTime sensor) const {
  const std::int64_t time_ns =
      std::clamp(saturating_subtract(sensor.ns, anchor_sensor_.ns), -kFarthest_ns, kFarthest_ns);
  return saturating_add(anchor_offset_ns_, rounded(envelope_.at(time_ns)));
}

void ClockModel::anchor(SensorTime sensor, std::int64_t offset_ns) {
  anchored_ = true;
  anchor_sensor_ = sensor;
  anchor_offset_ns_ = offset_ns;
  newest_ = sensor;
  candidate_ = {};
  envelope_.restart();
  envelope_.add(0, 0);
}

void ClockModel::accept(SensorTime sensor, std::int64_t offset_ns) {
  newest_ = std::max(newest_, sensor);
  envelope_.add(
      std::clamp(saturating_subtract(sensor.ns, anchor_sensor_.ns), -kFarthest_ns, kFarthest_ns),
      saturating_subtract(offset_ns, anchor_offset_ns_));
}

// A packet that is later still than the others is late; one that is much earlier shows that they
// were, and only it counts.
void ClockModel::collect(SensorTime sensor, HostTime host, std::int64_t offset_ns,
                         std::int64_t residual_ns) {
  const std::int64_t above_ns = saturating_subtract(offset_ns, candidate_.offset_ns);
  if (candidate_.packets == 0 || above_ns < -threshold_ns_) {
    candidate_ = {1, host, sensor, offset_ns, residual_ns};
    return;
  }
  if (above_ns > threshold_ns_) return;
  ++candidate_.packets;
  if (above_ns >= 0) return;
  candidate_.sensor = sensor;
  candidate_.offset_ns = offset_ns;
  candidate_.residual_ns = residual_ns;
}

// Packets are never early, nor does a sensor's time go back, but by a jump.
bool ClockModel::confirmed(HostTime now) const {
  if (candidate_.packets < kConfirmations) return false;
  const bool went_back = saturating_subtract(newest_.ns, candidate_.sensor.ns) > threshold_ns_;
  return candidate_.residual_ns < 0 || went_back ||
         saturating_subtract(now.ns, candidate_.since.ns) > kLongestDelay_ns;
}

}  // namespace glint
