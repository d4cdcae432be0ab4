// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/stage_stats.hpp"
#include "daemon/trajectory_history.hpp"
#include "driver/core/clock_model.hpp"
#include "driver/core/clock_source.hpp"
#include "driver/core/scan_assembler.hpp"
#include "slam/load_level.hpp"
#include "slam/map.hpp"
#include "slam/map_correction.hpp"
#include "slam/map_memory.hpp"
#include "slam/odometry_estimate.hpp"

namespace glint::daemon {

/// The last packet that was not taken because metadata say otherwise. Value type.
struct RefusedPacket {
  std::size_t bytes = 0;            ///< Of another size than the sensor's; 0: there was none.
  std::uint64_t serial_number = 0;  ///< Of another sensor; 0: there was none.
  std::uint32_t init_id = 0;        ///< Of another start of the sensor; 0: there was none.
};

/// What the IMU tells of the sensor's mounting. Value type.
struct ImuStatus {
  std::uint64_t packets = 0;
  std::uint64_t bad_packets = 0;  ///< Of an IMU packet's size, but none.
  double rate_hz = 0.0;           ///< Measurements a second.
  /// Acceleration measured at rest, m/s^2, sensor frame: it points up.
  std::optional<Eigen::Vector3d> up_mps2;
  double mount_tilt_deg = 0.0;  ///< Between it and the up of mount.T_base_sensor.
};

/// What odometry knows after a scan. Immutable once published; any thread may read it.
struct Snapshot {
  std::uint64_t scans = 0;  ///< Scans that gave an estimate.
  std::optional<slam::OdometryEstimate> estimate;
  slam::MapCorrection correction;
  HostTime host_time;           ///< The estimate's stamp by the clock model; 0 if unknown.
  std::int64_t arrival_ns = 0;  ///< Arrival of the packet that completed the scan, steady clock.
  ClockSource clock_source = ClockSource::kInternal;  ///< What the stamps are taken from.
  ClockStatus clock;
  bool paused = false;
  TrajectoryHistory history;

  AssemblerCounters packets;
  RefusedPacket refused;
  std::optional<PacketHealth> packet_health;  ///< Of the latest lidar packet that says it.
  /// Came before the metadata of the sensor, or of this start of it; dropped.
  std::uint64_t early_packets = 0;
  ImuStatus imu;
  std::uint64_t paused_scans = 0;                       ///< Scans not used because of a pause.
  slam::LoadLevel load_level = slam::LoadLevel::kFull;  ///< What odometry leaves out now.
  /// Scans of which something was to be left out, by what; see slam::kLoadLevelNames.
  std::array<std::uint64_t, slam::kLoadLevels> shed_scans{};
  std::uint64_t dropped_keyframes = 0;  ///< The back end was too slow for them.
  StageStats stages;
};

/// What the back end knows after a keyframe. Immutable once published.
struct MapState {
  std::shared_ptr<const slam::MapSnapshot> map;  ///< Never null.
  slam::MapMemory memory;
  DurationStats backend;
  DurationStats pgo;
  std::uint64_t loops_accepted = 0;
  std::uint64_t loops_rejected = 0;
  std::string session_file;  ///< Empty: no session is kept, or none yet.
  double restored = 1.0;     ///< Of an earlier map, how much is there.
  std::uint64_t unreadable_keyframes = 0;
  bool only_read = false;  ///< Nothing is added to the map: the sensor is followed in it.
  std::uint64_t store_failures = 0;
  std::string store_error;
};

/// A pose is stale when it is older than three scan periods. It is never TRACKING then.
inline bool is_stale(const Snapshot& snapshot, std::int64_t now_ns, std::int64_t scan_period_ns) {
  return now_ns - snapshot.arrival_ns > 3 * scan_period_ns;
}

/// The state that clients are told at steady time `now_ns`: INIT before the first pose, PAUSED
/// while paused, LOCALIZING while its place in the map is looked for, DEGRADED in place of TRACKING
/// when the pose is stale, else the estimate's.
inline slam::TrackingState client_state(const Snapshot& snapshot, std::int64_t now_ns,
                                        std::int64_t scan_period_ns) {
  using State = slam::TrackingState;
  if (snapshot.paused) return State::kPaused;
  if (!snapshot.estimate) return State::kInit;
  const State state = snapshot.estimate->state;
  if (state != State::kLost && !snapshot.correction.placed) return State::kLocalizing;
  const bool stale = is_stale(snapshot, now_ns, scan_period_ns);
  return state == State::kTracking && stale ? State::kDegraded : state;
}

}  // namespace glint::daemon
