// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/timetable.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::synth {
namespace {

constexpr double kStraightStep_m = 0.5;
constexpr double kArcStep_rad = 0.1;
constexpr int kLeastSteps = 2;  // Of a piece: between two stops one must get going.
// On a slope of 1 one is slower by this factor more.
constexpr double kSlowerBySlope = 1.5;

// Speed after `way_m` of constant acceleration.
double accelerated_mps(double speed_mps, double acceleration_mps2, double way_m) {
  return std::sqrt(speed_mps * speed_mps + 2.0 * acceleration_mps2 * way_m);
}

}  // namespace

Timetable::Timetable(Way way, const MotionLimits& limits) : way_(std::move(way)) {
  place_nodes(limits);
  std::vector<double> speed_mps;
  for (const Node& node : nodes_) {
    speed_mps.push_back(node.turn_rad != 0.0 ? 0.0 : speed_limit_mps(node.way_m, limits));
  }
  const std::size_t last = nodes_.size() - 1;
  const auto speed_up = [&](std::vector<double>& speeds) {
    for (std::size_t i = 0; i < last; ++i) {
      speeds[i + 1] = std::min(
          speeds[i + 1], accelerated_mps(speeds[i], limits.acceleration_mps2, way_between_m(i)));
    }
  };
  // Twice round: what holds at the end of a round holds at the start of the next.
  for (int i = 0; i < 2; ++i) {
    speed_mps[0] = speed_mps[last] = std::min(speed_mps[0], speed_mps[last]);
    speed_up(speed_mps);
    speed_mps[0] = speed_mps[last];
    for (std::size_t k = last; k > 0; --k) {
      speed_mps[k - 1] =
          std::min(speed_mps[k - 1],
                   accelerated_mps(speed_mps[k], limits.acceleration_mps2, way_between_m(k - 1)));
    }
  }
  later_ = make_round(speed_mps);
  speed_mps[0] = 0.0;
  speed_up(speed_mps);
  first_ = make_round(std::move(speed_mps));
}

void Timetable::place_nodes(const MotionLimits& limits) {
  nodes_.push_back({.way_m = 0.0});
  for (const Way::Piece& piece : way_.pieces()) {
    if (piece.length_m == 0.0) {
      // The turn's rate rises and falls like a parabola, so its peak is 1.5 times its mean.
      nodes_.back().turn_rad = piece.turn_rad;
      nodes_.back().wait_s = 1.5 * std::abs(piece.turn_rad) / limits.yaw_rate_radps;
      continue;
    }
    const double steps = piece.turn_rad == 0.0 ? piece.length_m / kStraightStep_m
                                               : std::abs(piece.turn_rad) / kArcStep_rad;
    const int count = std::max(kLeastSteps, static_cast<int>(std::ceil(steps)));
    for (int i = 1; i <= count; ++i) {
      nodes_.push_back(
          {.way_m = piece.start_m + piece.length_m * (static_cast<double>(i) / count)});
    }
  }
}

double Timetable::speed_limit_mps(double way_m, const MotionLimits& limits) const {
  const double slope = way_.at(way_m).slope;
  const double cruise_mps = limits.speed_mps / (1.0 + kSlowerBySlope * std::abs(slope));
  // What matters is by how much the direction changes in the time over which it is smoothed: a
  // small kink is no reason to brake, a wide curve is at high speed.
  const auto possible = [&](double speed_mps) {
    const double half_m = 0.5 * speed_mps * limits.smoothing_s;
    const double turn_radps =
        (way_.turning_rad(way_m + half_m) - way_.turning_rad(way_m - half_m)) / limits.smoothing_s;
    const double pitch_radps =
        std::abs(way_.at(way_m + half_m).slope - way_.at(way_m - half_m).slope) /
        limits.smoothing_s;
    return turn_radps <= limits.yaw_rate_radps &&
           speed_mps * std::max(turn_radps, pitch_radps) <= limits.lateral_mps2;
  };
  if (possible(cruise_mps)) return cruise_mps;
  double low = 0.0;
  double high = cruise_mps;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (possible(middle) ? low : high) = middle;
  }
  return low;
}

double Timetable::way_between_m(std::size_t node) const {
  return nodes_[node + 1].way_m - nodes_[node].way_m;
}

Timetable::Round Timetable::make_round(std::vector<double> speed_mps) const {
  Round round{std::move(speed_mps), {0.0}, 0.0};
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
    const double mean_mps = 0.5 * (round.speed_mps[i] + round.speed_mps[i + 1]);
    round.arrival_s.push_back(round.arrival_s.back() + nodes_[i].wait_s +
                              way_between_m(i) / mean_mps);
  }
  round.duration_s = round.arrival_s.back() + nodes_.back().wait_s;
  return round;
}

Timetable::State Timetable::at(double t_s) const {
  if (t_s < first_.duration_s) return at(first_, std::max(0.0, t_s));
  const double later_s = t_s - first_.duration_s;
  const double rounds = std::floor(later_s / later_.duration_s);
  State state = at(later_, later_s - rounds * later_.duration_s);
  state.point.heading_rad += (rounds + 1.0) * way_.turn_rad();
  return state;
}

Timetable::State Timetable::at(const Round& round, double t_s) const {
  const auto next = std::upper_bound(round.arrival_s.begin(), round.arrival_s.end(), t_s);
  const auto i = static_cast<std::size_t>(next - round.arrival_s.begin()) - 1;
  const Node& node = nodes_[i];
  const double since_s = t_s - round.arrival_s[i];
  if (since_s < node.wait_s) {
    State state{way_.at(node.way_m), 0.0};
    const double x = since_s / node.wait_s;
    state.point.heading_rad -= node.turn_rad * (1.0 - x * x * (3.0 - 2.0 * x));
    return state;
  }
  if (i + 1 == nodes_.size()) return {way_.at(node.way_m), round.speed_mps[i]};
  const double moving_s = since_s - node.wait_s;
  const double whole_s = round.arrival_s[i + 1] - round.arrival_s[i] - node.wait_s;
  const double gain_mps = round.speed_mps[i + 1] - round.speed_mps[i];
  const double way_m = moving_s * (round.speed_mps[i] + 0.5 * gain_mps * moving_s / whole_s);
  return {way_.at(node.way_m + way_m), round.speed_mps[i] + gain_mps * moving_s / whole_s};
}

}  // namespace glint::synth
