// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/recent_map.hpp"

#include <utility>

namespace glint::slam {
namespace {

// From the start of a large rebuild to its end; more than it takes.
constexpr int kRebuild_scans = 3;

}  // namespace

RecentMap::RecentMap(const LocalMapOptions& options, double reach_m)
    : options_(options), reach_m_(reach_m), older_(options) {}

void RecentMap::associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                          const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) {
  older_.map.associate(points_m, ground_count, T_odom_scan, terms);
}

void RecentMap::associate_again(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                                const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) {
  older_.map.associate_again(points_m, ground_count, T_odom_scan, terms);
}

void RecentMap::add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                    const Pose& T_odom_scan) {
  const Eigen::Vector3d& place_m = T_odom_scan.translation_m;
  if (younger_ && younger_->is_left_by(place_m, reach_m_)) {
    older_ = std::move(*younger_);
    younger_.reset();
  }
  if (reach_m_ > 0.0 && !younger_ && older_.is_left_by(place_m, reach_m_)) {
    younger_.emplace(options_);
  }
  older_.add(points_m, ground_count, T_odom_scan);
  if (younger_) younger_->add(points_m, ground_count, T_odom_scan);
}

void RecentMap::clear() {
  older_ = Generation(options_);
  younger_.reset();
}

void RecentMap::Generation::add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                                const Pose& T_odom_scan) {
  if (!begun_at_m) begun_at_m = T_odom_scan.translation_m;
  map.add(points_m, ground_count, T_odom_scan);
  mend();
}

bool RecentMap::Generation::is_left_by(const Eigen::Vector3d& place_m, double reach_m) const {
  return begun_at_m && (place_m - *begun_at_m).norm() > reach_m;
}

void RecentMap::Generation::mend() {
  if (!rebuild.valid()) {
    std::optional<LocalMap::Rebuild> begun = map.take_rebuild();
    if (!begun) return;
    rebuild_age_scans = 0;
    // Where no thread is to be had, get() does the work.
    rebuild = std::async([work = std::move(*begun)]() mutable {
      work.tree.run();
      return std::move(work);
    });
  } else if (++rebuild_age_scans == kRebuild_scans) {
    map.adopt(rebuild.get());
  }
}

}  // namespace glint::slam
