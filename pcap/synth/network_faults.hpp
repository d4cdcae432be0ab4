// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "driver/core/packet_source.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {

/// What a network does to datagrams: each by chance, as a share of all (0 to 1).
struct NetworkFaults {
  double loss = 0.0;
  double duplicates = 0.0;    ///< Arrive a second time, up to three datagrams later.
  double reordering = 0.0;    ///< Arrive one to three datagrams late.
  std::int64_t delay_ns = 0;  ///< On the way, each of them; at least 0.
};

/// How often it did so.
struct FaultCounts {
  std::uint64_t sent = 0;  ///< By the sensor.
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t delayed = 0;
};

/// What becomes of one datagram.
enum class DatagramFate { kArrives, kLost, kDelayed, kDuplicated };

/// A bad line between a sensor and its host. Thread-compatible.
class FaultyNetwork {
 public:
  /// @throws OptionError for shares that are none, or a delay below 0.
  FaultyNetwork(const NetworkFaults& faults, std::uint64_t seed);

  /// From now on; what is on the way stays so. @throws OptionError as above.
  void set_faults(const NetworkFaults& faults);
  /// Called with every datagram that is sent, and what becomes of it.
  void set_observer(std::function<void(const RawPacket&, DatagramFate)> observer) {
    observer_ = std::move(observer);
  }

  /// The next datagram that arrives of those that `send` gives, its host time that of its arrival.
  /// What is on the way when they end still arrives; more may follow later.
  SourceStatus receive(const std::function<SourceStatus(RawPacket&)>& send, RawPacket& packet);
  [[nodiscard]] const FaultCounts& counts() const { return counts_; }

 private:
  struct Held {
    RawPacket packet;
    int behind = 0;  ///< Arrives after so many others.
  };
  DatagramFate draw_fate();
  bool arrive_late(RawPacket& packet, bool line_is_empty);
  void pass_held();
  void hold(const RawPacket& packet);

  NetworkFaults faults_;
  std::function<void(const RawPacket&, DatagramFate)> observer_;
  Random random_;
  std::vector<Held> held_;
  HostTime now_;  ///< Of the latest datagram, but for the delay.
  FaultCounts counts_;
};

}  // namespace glint::synth
