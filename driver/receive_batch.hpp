// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <sys/socket.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "driver/core/time.hpp"
#include "driver/socket_address.hpp"

namespace glint {

/// What was not handed out, and why. Thread-safe.
struct ReceiveCounters {
  std::atomic<std::uint64_t> foreign = 0;    ///< From another address than the one wanted.
  std::atomic<std::uint64_t> truncated = 0;  ///< Cut by the kernel: larger than a datagram may be.
  std::atomic<std::uint64_t> kernel_drops = 0;  ///< The socket's receive buffer was full.
};

/// The kernel's count of a socket's drops, which wraps at 2^32. Thread-compatible.
class DropCount {
 public:
  /// Drops since the count told last.
  std::uint32_t added(std::uint32_t told);

 private:
  std::uint32_t last_ = 0;
};

/// The datagrams that wait in one socket, read with one call of the kernel, each with its time of
/// arrival. Buffers go out and come back by swap and are kept at the size of the largest datagram
/// so far, so that in the long run nothing is allocated, cleared or copied. Thread-compatible.
class ReceiveBatch {
 public:
  static constexpr std::size_t kMessages = 32;
  static constexpr std::size_t kMaxDatagramBytes = 65'535;

  /// Datagrams of more than `max_bytes` are cut by the kernel, and so not handed out.
  explicit ReceiveBatch(std::size_t max_bytes = kMaxDatagramBytes);

  /// Reads what waits in `socket`, without waiting; what is left of the last batch is lost. Only
  /// datagrams from `source` are kept, if it is given; the others are counted. Returns 0 or the
  /// kernel's error number (EAGAIN: nothing was there).
  int receive(int socket, const std::optional<SocketAddress>& source, ReceiveCounters& counters);

  [[nodiscard]] bool empty() const { return next_ == received_; }
  /// More may have waited in the socket than a batch holds.
  [[nodiscard]] bool full() const { return received_ == kMessages; }
  /// When the oldest datagram left arrived. Requires !empty().
  [[nodiscard]] HostTime time() const { return slots_[next_].time; }
  /// Swaps the oldest datagram's bytes into `bytes`. Requires !empty().
  void take(std::vector<std::byte>& bytes);

 private:
  struct Slot {
    HostTime time;
    bool wanted = false;
    sockaddr_storage from;
    std::vector<std::byte> bytes;
    // First the buffer, then the spill, where the rest of a datagram goes that is larger than all
    // before it.
    std::array<iovec, 2> parts;
    alignas(cmsghdr) std::array<std::byte, 256> control;
  };

  void arm(std::size_t i);
  void look_at(std::size_t i, const std::optional<SocketAddress>& source,
               ReceiveCounters& counters);
  void skip_unwanted();

  const std::size_t max_bytes_;
  // Memory that the kernel gives only once it is written to.
  const std::unique_ptr<std::byte[]> spill_;
  std::vector<Slot> slots_;
  std::vector<mmsghdr> messages_;
  std::size_t largest_ = 0;   // bytes of the largest datagram so far
  std::size_t received_ = 0;  // slots of the batch
  std::size_t next_ = 0;
  DropCount drops_;
};

}  // namespace glint
