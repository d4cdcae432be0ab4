// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "driver/core/packet_source.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {

/// What a network does to datagrams: each by chance, as a share of all (0 to 1).
struct NetworkFaults {
  double loss = 0.0;
  double duplicates = 0.0;  ///< Arrive a second time, up to three datagrams later.
  double reordering = 0.0;  ///< Arrive one to three datagrams late.
};

/// How often it did so.
struct FaultCounts {
  std::uint64_t sent = 0;  ///< By the sensor.
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t delayed = 0;
};

/// A bad line between a sensor and its host. Thread-compatible.
class FaultyNetwork {
 public:
  /// @throws OptionError for shares that are none.
  FaultyNetwork(const NetworkFaults& faults, std::uint64_t seed);

  /// The next datagram that arrives of those that `send` gives; what is on the way when it ends
  /// still arrives.
  SourceStatus receive(const std::function<SourceStatus(RawPacket&)>& send, RawPacket& packet);
  [[nodiscard]] const FaultCounts& counts() const { return counts_; }

 private:
  struct Held {
    RawPacket packet;
    int behind = 0;  ///< Arrives after so many others.
  };
  bool arrive_late(RawPacket& packet, bool line_is_empty);
  void hold(const RawPacket& packet);

  const NetworkFaults faults_;
  Random random_;
  std::vector<Held> held_;
  HostTime now_;  ///< Of the latest arrival.
  FaultCounts counts_;
};

}  // namespace glint::synth
