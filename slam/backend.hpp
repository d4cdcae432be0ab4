// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "driver/core/clock.hpp"
#include "slam/config.hpp"
#include "slam/keyframe.hpp"
#include "slam/map.hpp"
#include "slam/session_store.hpp"

namespace glint::slam {

/// What the back end tells odometry and clients: where the odometry frame lies in the map frame.
/// `epoch` steps each time T_map_odom jumps.
struct MapCorrection {
  Pose T_map_odom;
  std::uint32_t epoch = 0;
};

/// Keyframes in, map and session out. Thread-compatible; owned by the backend thread.
class Backend {
 public:
  /// `session_file`: where the session is kept; empty for none. @throws InputError if it cannot be
  /// created.
  explicit Backend(const SlamConfig& config, const std::filesystem::path& session_file = {},
                   Clock clock = {});
  ~Backend();
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;

  /// Whose scans the keyframes that follow are of.
  void use_sensor(const SensorInfo& info);
  void process(const Keyframe& keyframe);
  [[nodiscard]] const MapCorrection& correction() const { return correction_; }
  /// The map now; immutable, to be handed to clients.
  [[nodiscard]] std::shared_ptr<const MapSnapshot> snapshot() const { return snapshot_; }
  /// Wall and CPU time of the last process() call, ns.
  [[nodiscard]] std::int64_t last_wall_ns() const { return last_wall_ns_; }
  [[nodiscard]] std::int64_t last_cpu_ns() const { return last_cpu_ns_; }
  /// Keyframes and sensors the session file could not take, and why the last one could not.
  [[nodiscard]] std::uint64_t store_failures() const { return store_failures_; }
  [[nodiscard]] std::string_view store_error() const;

 private:
  const SlamConfig config_;
  const Clock clock_;
  std::optional<VoxelMap> map_;  ///< Made with the first keyframe, whose ranges set the voxels.
  std::unique_ptr<SessionStore> store_;
  MapCorrection correction_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::size_t keyframe_count_ = 0;
  std::int64_t last_wall_ns_ = 0;
  std::int64_t last_cpu_ns_ = 0;
  std::uint64_t store_failures_ = 0;
};

}  // namespace glint::slam
