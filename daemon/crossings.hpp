// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "daemon/bounded_queue.hpp"
#include "daemon/command_mailbox.hpp"
#include "daemon/snapshot.hpp"
#include "daemon/snapshot_slot.hpp"
#include "driver/core/packet_source.hpp"
#include "slam/keyframe.hpp"

namespace glint::daemon {

/// A packet on its way from the receive thread to odometry.
struct ReceivedPacket {
  RawPacket packet;
  std::int64_t arrival_ns = 0;  ///< Steady clock of this machine.
  /// No packet: the stream fell silent, so that what is unfinished will stay so.
  bool silence = false;
};

/// How the packet source fares.
enum class SourceState { kWaiting, kRunning, kStalled, kEnded, kFailed };

/// What the receive thread tells of itself. Thread-safe.
struct SourceHealth {
  std::atomic<SourceState> state{SourceState::kWaiting};
  std::atomic<std::uint64_t> packets{0};
  std::atomic<std::uint64_t> kernel_drops{0};
  std::atomic<std::uint64_t> foreign{0};
  std::string error;  ///< Written before `state` becomes kFailed, never after.
};

using Job = std::function<void()>;

/// Everything that two threads of the runtime share.
struct Crossings {
  explicit Crossings(std::size_t packet_capacity)
      : packets(packet_capacity), keyframes(16), jobs(64) {}

  void close() {
    packets.close();
    keyframes.close();
    jobs.close();
  }

  BoundedQueue<ReceivedPacket> packets;    ///< receive -> odometry
  BoundedQueue<slam::Keyframe> keyframes;  ///< odometry -> backend
  BoundedQueue<Job> jobs;                  ///< main -> worker
  CommandMailbox commands;                 ///< main, backend -> odometry
  SnapshotSlot<Snapshot> snapshot;         ///< odometry -> main
  SnapshotSlot<MapState> map;              ///< backend -> main, worker
  SourceHealth source;                     ///< receive -> main
};

}  // namespace glint::daemon
