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
  /// `lossless`: a full queue makes the source wait (replay) instead of dropping the oldest packet
  /// (live).
  ReceiveThread(PacketSource& source, bool lossless, Crossings& crossings, Heartbeat& heartbeat)
      : source_(source), lossless_(lossless), crossings_(crossings), heartbeat_(heartbeat) {}

  /// Until the source ends; closes the packet queue then.
  void run();

 private:
  void take_packet();
  [[nodiscard]] bool is_sign_of_life() const;
  void tell_silence();

  PacketSource& source_;
  const bool lossless_;
  Crossings& crossings_;
  Heartbeat& heartbeat_;
  ReceivedPacket received_;
  std::int64_t now_ns_ = 0;
};

}  // namespace glint::daemon
