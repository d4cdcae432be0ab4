// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

constexpr double kAcceleration_s = 1.5;  // Time from standstill to full speed.

// 0 to 1 with zero first and second derivatives at both ends, and its integral.
double smooth_step(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * c * (10 + c * (-15 + 6 * c));
}
double smooth_step_integral(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * c * c * (2.5 + c * (-3 + c)) + std::max(0.0, x - 1.0);
}

}  // namespace

void Itinerary::add(double duration_s, std::function<State(double)> at) {
  pieces_.push_back({total_s_, duration_s, std::move(at)});
  total_s_ += duration_s;
}

void Itinerary::rest(double seconds) {
  const PathPoint here = pieces_.empty() ? PathPoint{} : at(total_s_).point;
  add(seconds, [here](double) { return State{here, 0.0}; });
}

void Itinerary::follow(std::function<PathPoint(double)> path, double length_m, double speed_mps) {
  // The ramps cover half of speed * time each.
  const double cruise_s = std::max(0.0, length_m / speed_mps - kAcceleration_s);
  const double top_mps = length_m / (cruise_s + kAcceleration_s);
  const double duration_s = cruise_s + 2 * kAcceleration_s;
  if (pieces_.size() == 1 && pieces_[0].duration_s == total_s_) {
    // A first rest is where the path starts.
    const PathPoint start = path(0.0);
    pieces_[0].at = [start](double) { return State{start, 0.0}; };
  }
  add(duration_s, [=, path = std::move(path)](double t_s) {
    const double up = smooth_step_integral(t_s / kAcceleration_s) * kAcceleration_s;
    const double down = smooth_step_integral((t_s - kAcceleration_s - cruise_s) / kAcceleration_s) *
                        kAcceleration_s;
    const double speed_mps_now =
        top_mps * (smooth_step(t_s / kAcceleration_s) -
                   smooth_step((t_s - kAcceleration_s - cruise_s) / kAcceleration_s));
    return State{path(std::clamp(top_mps * (up - down), 0.0, length_m)), speed_mps_now};
  });
}

void Itinerary::circle(std::function<PathPoint(double)> path, double speed_mps) {
  if (pieces_.size() == 1) {
    const PathPoint start = path(0.0);
    pieces_[0].at = [start](double) { return State{start, 0.0}; };
  }
  add(std::numeric_limits<double>::infinity(), [speed_mps, path = std::move(path)](double t_s) {
    const double way_m = speed_mps * smooth_step_integral(t_s / kAcceleration_s) * kAcceleration_s;
    return State{path(way_m), speed_mps * smooth_step(t_s / kAcceleration_s)};
  });
}

void Itinerary::turn(double angle_rad, double seconds) {
  const PathPoint here = at(total_s_).point;
  add(seconds, [=](double t_s) {
    PathPoint point = here;
    point.heading_rad += angle_rad * smooth_step(t_s / seconds);
    return State{point, 0.0};
  });
}

Itinerary::State Itinerary::at(double t_s) const {
  double t = std::max(0.0, t_s);
  // Over again; the initial rest belongs to the start only.
  if (std::isfinite(total_s_) && t > total_s_) {
    const double once_s = total_s_ - pieces_.front().duration_s;
    if (once_s > 0) t = pieces_.front().duration_s + std::fmod(t - total_s_, once_s);
  }
  for (const Piece& piece : pieces_) {
    if (t <= piece.start_s + piece.duration_s) return piece.at(t - piece.start_s);
  }
  return pieces_.back().at(pieces_.back().duration_s);
}

WalkingMotion::WalkingMotion(Itinerary itinerary, double sensor_height_m, std::uint64_t seed)
    : itinerary_(std::move(itinerary)), sensor_height_m_(sensor_height_m) {
  Random random{seed, 0x6A17ULL};
  step_hz_ = random.uniform(1.7, 2.1);
  phase_rad_ = random.uniform(0.0, 2.0 * M_PI);
}

Pose WalkingMotion::at(double t_s) const {
  const Itinerary::State state = itinerary_.at(t_s);
  const double gait = std::clamp(state.speed_mps / 1.2, 0.0, 1.5);
  // Up and down once a step, side to side once every two.
  const double step = 2.0 * M_PI * step_hz_ * t_s + phase_rad_;
  const double stride = 0.5 * step;
  const double bob_m = gait * 0.022 * std::sin(step);
  const double sway_m = gait * 0.025 * std::sin(stride);
  const double roll_rad = gait * 0.018 * std::sin(stride + 0.4);
  const double pitch_rad = gait * 0.014 * std::sin(step + 1.1);
  const double yaw_rad = gait * 0.030 * std::sin(stride + 2.0);

  const double heading = state.point.heading_rad;
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(heading + yaw_rad, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
  pose.translation_m = {state.point.x_m - sway_m * std::sin(heading),
                        state.point.y_m + sway_m * std::cos(heading), sensor_height_m_ + bob_m};
  return pose;
}

}  // namespace glint::synth
