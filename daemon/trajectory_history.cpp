// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/trajectory_history.hpp"

#include <algorithm>
#include <cmath>

namespace glint::daemon {
namespace {

constexpr std::size_t kChunkPoses = 256;

/// Rank in the order of precedence (see TrackingState): lower wins.
int precedence(slam::TrackingState state) {
  using S = slam::TrackingState;
  switch (state) {
    case S::kPaused:
      return 0;
    case S::kLost:
      return 1;
    case S::kLocalizing:
      return 2;
    case S::kInit:
      return 3;
    case S::kDegraded:
      return 4;
    case S::kTracking:
      return 5;
  }
  return 0;
}

}  // namespace

TrajectoryHistory::TrajectoryHistory(std::size_t max_poses)
    : max_chunks_(std::max<std::size_t>(1, max_poses / kChunkPoses)),
      sealed_(std::make_shared<const ChunkList>()) {}

void TrajectoryHistory::append(const PoseRecord& record) {
  if (first_ < end() && record.stamp <= at(end() - 1).stamp) {
    first_ = end();
    sealed_ = std::make_shared<const ChunkList>();
    open_.clear();
  }
  open_.push_back(record);
  if (open_.size() < kChunkPoses) return;

  auto sealed = std::make_shared<ChunkList>(*sealed_);
  sealed->push_back(std::make_shared<const Chunk>(std::move(open_)));
  if (sealed->size() > max_chunks_) {
    sealed->erase(sealed->begin());
    first_ += kChunkPoses;
  }
  sealed_ = std::move(sealed);
  open_ = {};
}

std::uint64_t TrajectoryHistory::end() const {
  return first_ + sealed_->size() * kChunkPoses + open_.size();
}

const PoseRecord& TrajectoryHistory::at(std::uint64_t index) const {
  const std::uint64_t offset = index - first_;
  const std::uint64_t chunk = offset / kChunkPoses;
  if (chunk < sealed_->size()) return (*(*sealed_)[chunk])[offset % kChunkPoses];
  return open_[offset - sealed_->size() * kChunkPoses];
}

std::uint64_t TrajectoryHistory::first_after(SensorTime stamp) const {
  std::uint64_t low = first_;
  std::uint64_t high = end();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (at(middle).stamp <= stamp) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

std::optional<PoseRecord> pose_at(const TrajectoryHistory& history, SensorTime stamp) {
  const std::uint64_t after = history.first_after(stamp);
  if (after == history.first()) return std::nullopt;
  const PoseRecord& a = history.at(after - 1);
  if (a.stamp == stamp) return a;
  if (after == history.end()) return std::nullopt;
  const PoseRecord& b = history.at(after);
  if (a.segment != b.segment) return std::nullopt;

  const double fraction =
      static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  PoseRecord out = b;
  out.stamp = stamp;
  out.T_odom_sensor = interpolate(a.T_odom_sensor, b.T_odom_sensor, fraction);
  out.sequence = a.sequence + fraction * (b.sequence - a.sequence);
  out.velocity = a.velocity + fraction * (b.velocity - a.velocity);
  if (a.host_time.ns != 0 && b.host_time.ns != 0) {
    out.host_time =
        a.host_time + std::llround(fraction * static_cast<double>(b.host_time - a.host_time));
  }
  out.clock_sigma_ns = std::max(a.clock_sigma_ns, b.clock_sigma_ns);
  if (precedence(a.state) < precedence(b.state)) out.state = a.state;
  return out;
}

}  // namespace glint::daemon
