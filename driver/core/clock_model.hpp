// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>

#include "driver/core/lower_envelope.hpp"
#include "driver/core/time.hpp"

namespace glint {

/// A step of one of the two clocks against the other.
struct ClockJump {
  std::int64_t jump_ns = 0;    ///< By how much the offset changed.
  std::int64_t offset_ns = 0;  ///< Host minus sensor time, after it.
};

/// What a clock model has found out. Value type.
struct ClockStatus {
  bool known = false;          ///< A packet was received; without one, the rest is 0.
  std::int64_t offset_ns = 0;  ///< Host minus sensor time, at the newest packet.
  double skew_ppm = 0.0;       ///< How much faster the host's clock runs.
  std::int64_t sigma_ns = 0;   ///< Of a time converted near the newest packet.
  std::uint64_t jumps = 0;     ///< Since the start.
};

/// Sensor time to host time. Packets are only ever late, so offset and skew are those of the lower
/// envelope of receive time minus sensor time over the last minute; the shortest way of a packet to
/// this machine (some 0.1 ms) is part of the offset, for nothing tells the two apart. When either
/// clock steps by more than half a scan period, the model forgets and starts anew. What it knows
/// depends on the packets only. Thread-compatible; no allocation, never throws, safe for all times.
class ClockModel {
 public:
  explicit ClockModel(std::int64_t scan_period_ns) : threshold_ns_(scan_period_ns / 2) {}

  /// Takes a packet: when it was finished, and when it was received. A host time of 0 or less says
  /// nothing (a capture without times). Tells a jump once enough packets agree on it.
  std::optional<ClockJump> add(SensorTime sensor, HostTime host);

  /// Null before the first packet.
  [[nodiscard]] std::optional<HostTime> to_host(SensorTime sensor) const;
  [[nodiscard]] ClockStatus status() const;

 private:
  /// Packets that agree with each other but not with the model.
  struct Candidate {
    int packets = 0;
    HostTime since;                ///< Host time of the first one.
    SensorTime sensor;             ///< Of the one with the smallest offset,
    std::int64_t offset_ns = 0;    ///< and that offset.
    std::int64_t residual_ns = 0;  ///< Against the model.
  };

  [[nodiscard]] std::int64_t predicted_offset_ns(SensorTime sensor) const;
  void anchor(SensorTime sensor, std::int64_t offset_ns);
  void accept(SensorTime sensor, std::int64_t offset_ns);
  void collect(SensorTime sensor, HostTime host, std::int64_t offset_ns, std::int64_t residual_ns);
  [[nodiscard]] bool confirmed(HostTime now) const;

  const std::int64_t threshold_ns_;
  bool anchored_ = false;
  SensorTime anchor_sensor_;           ///< Times and offsets are relative to these, so that
  std::int64_t anchor_offset_ns_ = 0;  ///< floating point holds them exactly enough.
  LowerEnvelope envelope_;
  SensorTime newest_;  ///< Of the packets that fit.
  Candidate candidate_;
  std::uint64_t jumps_ = 0;
};

}  // namespace glint
