// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "slam/odometry_estimate.hpp"

namespace glint::daemon {

/// What is remembered of each past scan. Value type.
struct PoseRecord {
  SensorTime stamp;
  Pose T_odom_sensor;
  Twist velocity = Twist::Zero();  ///< As OdometryEstimate::velocity.
  slam::TrackingState state = slam::TrackingState::kInit;
  std::uint32_t segment = 0;
  std::uint32_t frame_id = 0;
  double sequence = 0.0;  ///< OdometryEstimate::sequence; a fraction: between two scans.
  HostTime host_time;     ///< Of the stamp; 0 if unknown.
  std::int64_t clock_sigma_ns = 0;
};

/// Past poses with strictly rising times, in chunks that copies of the history share: a copy costs
/// one reference count and the last, open chunk. Bounded: the oldest chunk goes. Value type.
class TrajectoryHistory {
 public:
  explicit TrajectoryHistory(std::size_t max_poses = 200'000);

  /// A pose that is not newer than the last one (the sensor's clock went back) starts a new
  /// history.
  void append(const PoseRecord& record);

  /// Records are numbered from the start of the program; first() is the oldest one still here, and
  /// end() is one past the newest. first() == end() when there is none.
  [[nodiscard]] std::uint64_t first() const { return first_; }
  [[nodiscard]] std::uint64_t end() const;
  /// Record `index`, first() <= index < end().
  [[nodiscard]] const PoseRecord& at(std::uint64_t index) const;
  /// Index of the first record with a time above `stamp`; end() if there is none.
  [[nodiscard]] std::uint64_t first_after(SensorTime stamp) const;

 private:
  using Chunk = std::vector<PoseRecord>;
  using ChunkList = std::vector<std::shared_ptr<const Chunk>>;

  std::size_t max_chunks_;
  std::uint64_t first_ = 0;
  std::shared_ptr<const ChunkList> sealed_;  ///< Full chunks.
  Chunk open_;
};

/// The pose at a time between two records: constant body velocity from one to the other, the worse
/// of their states. Null outside the covered span, or when tracking restarted in between.
std::optional<PoseRecord> pose_at(const TrajectoryHistory& history, SensorTime stamp);

}  // namespace glint::daemon
