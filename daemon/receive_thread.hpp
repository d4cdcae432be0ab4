// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "daemon/crossings.hpp"
#include "daemon/heartbeat.hpp"
#include "driver/core/packet_source.hpp"

namespace glint::daemon {

/// Body of the receive thread: packets from the source into the packet queue. Owned by that thread.
class ReceiveThread {
 public:
  struct Options {
    /// A full queue makes the source wait (replay) instead of dropping the oldest packet (live).
    bool lossless = false;
    /// A live stream without packets for so long is silent.
    std::int64_t silence_ns = 0;
  };

  ReceiveThread(PacketSource& source, Options options, Crossings& crossings, Heartbeat& heartbeat)
      : source_(source), options_(options), crossings_(crossings), heartbeat_(heartbeat) {}

  /// Until the source ends; closes the packet queue then.
  void run();

 private:
  void take_packet();
  void tell_silence();

  PacketSource& source_;
  const Options options_;
  Crossings& crossings_;
  Heartbeat& heartbeat_;
  ReceivedPacket received_;
  std::int64_t last_packet_ns_ = 0;
};

}  // namespace glint::daemon
