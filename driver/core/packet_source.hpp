// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driver/core/time.hpp"

namespace glint {

/// One datagram as it arrived, lidar or IMU. The buffer is meant to be reused.
struct RawPacket {
  HostTime host_time;
  std::uint16_t port = 0;  ///< UDP destination port.
  std::vector<std::byte> bytes;
};

enum class SourceStatus {
  kPacket,  ///< A packet was read.
  kIdle,    ///< Nothing within the waiting time; ask again (live only).
  kEnd,     ///< The capture is over, or the source was stopped.
  kError,   ///< The source broke; see error().
};

/// Where datagrams come from; live and replay share it. read() is called from one thread;
/// stop() may be called from any.
class PacketSource {
 public:
  virtual ~PacketSource() = default;
  /// Reads the next datagram into `packet`, reusing its buffer. Waits at most about 100 ms.
  virtual SourceStatus read(RawPacket& packet) = 0;
  /// Makes read() return kEnd soon.
  virtual void stop() = 0;
  /// From here on only datagrams from this IP address are taken; empty: from any. A source that
  /// knows its sensor by other means does nothing. May be called from any thread.
  virtual void set_source_address(const std::string& address) { static_cast<void>(address); }
  /// Datagrams that the kernel dropped before they could be read, since start; 0 in replay.
  [[nodiscard]] virtual std::uint64_t kernel_drops() const { return 0; }
  /// Datagrams from others than the sensor, since start; 0 where any sender is taken.
  [[nodiscard]] virtual std::uint64_t foreign() const { return 0; }
  /// What a user should know of the source, a sentence each; more may come at its end.
  [[nodiscard]] virtual std::vector<std::string> notices() const { return {}; }
  /// A sentence on what broke after kError; empty otherwise.
  [[nodiscard]] virtual const char* error() const { return ""; }
};

}  // namespace glint
