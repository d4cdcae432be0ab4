// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/backend.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint::slam {
namespace {

// The edge of the map's voxels when the configuration leaves it open: fine indoors, coarse in
// streets, so that the number of points follows the scene's surface in both.
double voxel_from_median_range_m(const Keyframe& keyframe) {
  std::vector<float> ranges_m;
  ranges_m.reserve(keyframe.points.size());
  for (const MapPoint& p : keyframe.points) ranges_m.push_back(std::hypot(p.x_m, p.y_m, p.z_m));
  if (ranges_m.empty()) return 0.1;
  const auto middle = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / 2);
  std::nth_element(ranges_m.begin(), middle, ranges_m.end());
  return std::clamp(static_cast<double>(*middle) / 40.0, 0.05, 0.5);
}

}  // namespace

Backend::Backend(const SlamConfig& config, const std::filesystem::path& session_file, Clock clock)
    : config_(config),
      clock_(clock),
      store_(session_file.empty() ? nullptr : std::make_unique<SessionStore>(session_file, config)),
      snapshot_(std::make_shared<const MapSnapshot>()) {}

Backend::~Backend() = default;

void Backend::use_sensor(const SensorInfo& info) {
  if (store_ && !store_->set_sensor(info)) ++store_failures_;
}

void Backend::process(const Keyframe& keyframe) {
  const std::int64_t wall_start_ns = clock_.monotonic_ns();
  const std::int64_t cpu_start_ns = clock_.thread_cpu_ns();
  const Pose T_map_sensor = correction_.T_map_odom * keyframe.estimate.T_odom_sensor;
  if (!map_) {
    const double voxel_m =
        config_.map_voxel_m > 0 ? config_.map_voxel_m : voxel_from_median_range_m(keyframe);
    map_.emplace(voxel_m, static_cast<std::size_t>(config_.map_max_points));
  }
  map_->insert(T_map_sensor, keyframe.points);
  if (store_ && !store_->add(keyframe, T_map_sensor)) ++store_failures_;
  ++keyframe_count_;

  auto snapshot = map_->snapshot();
  snapshot->keyframe_count = keyframe_count_;
  snapshot_ = std::move(snapshot);
  last_wall_ns_ = clock_.monotonic_ns() - wall_start_ns;
  last_cpu_ns_ = clock_.thread_cpu_ns() - cpu_start_ns;
}

std::string_view Backend::store_error() const { return store_ ? store_->error() : ""; }

}  // namespace glint::slam
