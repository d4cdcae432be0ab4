// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/bounded_queue.hpp"
#include "daemon/command_mailbox.hpp"
#include "daemon/commit_request.hpp"
#include "daemon/map_change.hpp"
#include "daemon/place_search_slot.hpp"
#include "daemon/scan_tap.hpp"
#include "daemon/snapshot.hpp"
#include "daemon/snapshot_slot.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"
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
  /// Steady clock at the last lidar packet; 0: none yet.
  std::atomic<std::int64_t> last_packet_ns{0};
  // Written before `state` becomes kEnded or kFailed, never after.
  std::string error;
  std::vector<std::string> notices;  ///< Those that came after the source was opened.
};

/// What the receive thread is told of the sensor. Thread-safe.
struct ExpectedPackets {
  /// Size of its lidar packets: others are no sign of life. 0: not known yet.
  std::atomic<std::size_t> lidar_bytes{0};
  /// A live stream without lidar packets for so long is silent.
  std::atomic<std::int64_t> silence_ns{kLeastSilenceNs};

  /// Shorter than that may be a machine's hiccup.
  static constexpr std::int64_t kLeastSilenceNs = 300'000'000;
};

using Job = std::function<void()>;

/// Everything that two threads of the runtime share.
struct Crossings {
  explicit Crossings(std::size_t packet_capacity)
      : packets(packet_capacity), keyframes(16), jobs(64), long_jobs(2) {}

  void close() {
    packets.close();
    keyframes.close();
    jobs.close();
    long_jobs.close();
    session_commit.close(false);
    map_change.close();
  }

  BoundedQueue<ReceivedPacket> packets;    ///< receive -> odometry
  BoundedQueue<slam::Keyframe> keyframes;  ///< odometry -> backend
  BoundedQueue<Job> jobs;                  ///< main -> worker
  BoundedQueue<Job> long_jobs;             ///< main -> jobs
  CommitRequest session_commit;            ///< jobs -> backend
  MapChangeSlot map_change;                ///< main -> backend
  PlaceSearchSlot place_search;            ///< main -> backend
  CommandMailbox commands;                 ///< main, backend -> odometry
  SnapshotSlot<Snapshot> snapshot;         ///< odometry -> main
  SnapshotSlot<MapState> map;              ///< backend -> main, worker
  SnapshotSlot<SensorInfo> sensor;         ///< main -> backend; null while it is not known
  ScanTap scan_tap;                        ///< odometry -> worker
  SourceHealth source;                     ///< receive -> main
  ExpectedPackets expected;                ///< main -> receive
  /// Initialization id of the last lidar packet, 0 when it has none: odometry -> main
  std::atomic<std::uint32_t> packet_init_id{0};
};

}  // namespace glint::daemon
