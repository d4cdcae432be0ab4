// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <vector>

#include "pcap/synth/motion/way.hpp"

namespace glint::synth {

/// How somebody or something can move.
struct MotionLimits {
  double speed_mps = 1.0;          ///< Where nothing else limits it.
  double acceleration_mps2 = 1.0;  ///< Along the way, up and down.
  double lateral_mps2 = 1.0;       ///< In curves and over humps.
  double yaw_rate_radps = 1.0;
  /// Corners are passed as if smoothed over so much time.
  double smoothing_s = 0.3;
};

/// When one is where on a way: as fast as the limits allow, from a standstill, round after round.
/// Speed is continuous, acceleration is not. Immutable.
class Timetable {
 public:
  Timetable(Way way, const MotionLimits& limits);

  struct State {
    WayPoint point;
    double speed_mps = 0.0;
  };
  /// `t_s` seconds after the start; before it as at it.
  [[nodiscard]] State at(double t_s) const;

  /// Of the first round, which begins at a standstill, and of each later one.
  [[nodiscard]] double first_round_s() const { return first_.duration_s; }
  [[nodiscard]] double round_s() const { return later_.duration_s; }
  [[nodiscard]] const Way& way() const { return way_; }

 private:
  /// A place between which and the next the acceleration is constant.
  struct Node {
    double way_m;
    double turn_rad = 0.0;  ///< On the spot, before one goes on.
    double wait_s = 0.0;    ///< While doing so.
  };
  struct Round {
    std::vector<double> speed_mps;  ///< At each node.
    std::vector<double> arrival_s;
    double duration_s = 0.0;
  };
  void place_nodes(const MotionLimits& limits);
  [[nodiscard]] double speed_limit_mps(double way_m, const MotionLimits& limits) const;
  [[nodiscard]] double way_between_m(std::size_t node) const;
  [[nodiscard]] Round make_round(std::vector<double> speed_mps) const;
  [[nodiscard]] State at(const Round& round, double t_s) const;

  const Way way_;
  std::vector<Node> nodes_;  ///< The last is the first, a round later.
  Round first_;
  Round later_;
};

}  // namespace glint::synth
