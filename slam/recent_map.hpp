// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <future>
#include <optional>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/local_map.hpp"
#include "slam/plane_map.hpp"

namespace glint::slam {

/// The local map without what was left behind long ago: where odometry comes back to a place after
/// a round, the surfaces of then lie beside those of now, by its drift, and would tear it to and
/// fro. (That the places are one is for loops to say.) Two maps grow, the second since the sensor
/// had gone `reach_m` from where the first began; when it has gone as far from there, the first one
/// goes and the second takes its place. Who stays about keeps all. Large subtrees are rebuilt by
/// threads of their own and taken in a fixed number of scans later, done or waited for: results
/// depend on the scans alone. Thread-compatible.
class RecentMap final : public PlaneMap {
 public:
  /// `reach_m` 0: nothing is forgotten but what is far away.
  RecentMap(const LocalMapOptions& options, double reach_m);

  void associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                 const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) override;
  void associate_again(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                       const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) override;
  void add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
           const Pose& T_odom_scan) override;
  void clear() override;
  /// Points of the map that scans are held against.
  [[nodiscard]] std::size_t size() const override { return older_.map.size(); }

 private:
  struct Generation {
    explicit Generation(const LocalMapOptions& options) : map(options) {}
    LocalMap map;
    std::optional<Eigen::Vector3d> begun_at_m;
    std::future<LocalMap::Rebuild> rebuild;
    int rebuild_age_scans = 0;

    void add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
             const Pose& T_odom_scan);
    void mend();
    [[nodiscard]] bool is_left_by(const Eigen::Vector3d& place_m, double reach_m) const;
  };

  LocalMapOptions options_;
  double reach_m_;
  Generation older_;
  std::optional<Generation> younger_;
};

}  // namespace glint::slam
