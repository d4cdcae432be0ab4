// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/cli/stage_statistics.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/sensor_info.hpp"
#include "slam/backend.hpp"
#include "slam/config.hpp"
#include "slam/odometry_estimate.hpp"
#include "slam/scan_images.hpp"

namespace glint::cli {

/// All that a replay found out.
struct ReplayResult {
  std::vector<slam::OdometryEstimate> estimates;  ///< One for each scan, in order.
  std::vector<slam::ScanImages> sample_images;    ///< A few scans' images, for the report.
  StageStatistics stages;
  std::shared_ptr<const slam::MapSnapshot> map;
  slam::MapCorrection correction;
  AssemblerCounters packets;
  std::vector<slam::LoopReport> loops;  ///< Every candidate, in order.
  std::uint64_t loops_accepted = 0;
  std::uint64_t loops_rejected = 0;
  std::uint64_t keyframes_not_stored = 0;
  std::string store_error;
  std::string source_error;  ///< Why the capture could not be read to its end; empty if it was.
  bool interrupted = false;
  double wall_s = 0.0;
};

/// The pose in the map, by all that the capture held.
inline Pose map_pose(const ReplayResult& result, const slam::OdometryEstimate& estimate) {
  return result.correction.map_pose(estimate.segment, static_cast<double>(estimate.sequence),
                                    estimate.T_odom_sensor);
}

/// Whether the scan was placed, well or not so well.
inline bool has_pose(const slam::OdometryEstimate& estimate) {
  return estimate.state == slam::TrackingState::kTracking ||
         estimate.state == slam::TrackingState::kDegraded;
}

struct ReplayOptions {
  slam::SlamConfig slam;
  slam::LoopSource loops;                                             ///< As Backend has it.
  Eigen::Quaterniond R_base_sensor = Eigen::Quaterniond::Identity();  ///< As Frontend has it.
  std::filesystem::path session_file;
  std::filesystem::path earlier_session;  ///< Whose map is gone on with; empty for none.
  std::uint64_t max_scans = 0;            ///< 0: all.
  /// Called after each scan with the number of scans so far; false ends the replay.
  std::function<bool(std::uint64_t)> on_scan;
};

/// Runs the pipeline over a source, one step after the other: packets -> scans -> poses -> map.
/// The result depends on the packets only, not on time. @throws InputError from set-up.
ReplayResult run_replay(PacketSource& source, const SensorInfo& info, const ReplayOptions& options);

}  // namespace glint::cli
