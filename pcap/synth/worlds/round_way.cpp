// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/round_way.hpp"

#include <cmath>
#include <numbers>

namespace glint::synth {

RoundWay::RoundWay(const Eigen::Vector3d& center_m, double x_m, double y_m, double radius_m,
                   double yaw_rad, bool clockwise)
    : center_m_(center_m),
      straight_x_m_(x_m - 2.0 * radius_m),
      straight_y_m_(y_m - 2.0 * radius_m),
      radius_m_(radius_m),
      yaw_rad_(yaw_rad),
      clockwise_(clockwise) {}

double RoundWay::length_m() const {
  return 2.0 * (straight_x_m_ + straight_y_m_ + std::numbers::pi * radius_m_);
}

Pose RoundWay::at(double way_m) const {
  const double length = length_m();
  double left_m = std::fmod(clockwise_ ? -way_m : way_m, length);
  if (left_m < 0.0) left_m += length;

  // Four times a straight piece and a quarter of a circle, from the lower left corner on.
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  Eigen::Vector2d at_m(-0.5 * straight_x_m_, -0.5 * straight_y_m_ - radius_m_);
  double heading_rad = 0.0;
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
    const Eigen::Vector2d leftwards(-ahead.y(), ahead.x());
    const double straight_m = side % 2 == 0 ? straight_x_m_ : straight_y_m_;
    at_m += std::min(left_m, straight_m) * ahead;
    left_m -= straight_m;
    if (left_m <= 0.0) break;
    const double turn_rad = std::min(left_m / radius_m_, kQuarter);
    at_m += radius_m_ * (std::sin(turn_rad) * ahead + (1.0 - std::cos(turn_rad)) * leftwards);
    heading_rad += turn_rad;
    left_m -= kQuarter * radius_m_;
    if (left_m <= 0.0) break;
  }
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw_rad_, Eigen::Vector3d::UnitZ()));
  const double ahead_rad = yaw_rad_ + heading_rad + (clockwise_ ? std::numbers::pi : 0.0);
  return {Eigen::Quaterniond(Eigen::AngleAxisd(ahead_rad, Eigen::Vector3d::UnitZ())),
          center_m_ + turn * Eigen::Vector3d(at_m.x(), at_m.y(), 0.0)};
}

}  // namespace glint::synth
