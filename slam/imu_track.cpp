// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/imu_track.hpp"

#include <algorithm>
#include <cmath>

#include "driver/core/pose.hpp"

namespace glint::slam {
namespace {

// Two seconds of the fastest sensors' measurements, ten of the usual 100 a second.
constexpr std::size_t kNodes = 1024;
// Measurements farther apart do not tell what was between them.
constexpr std::int64_t kLongestGap_ns = 60'000'000;
// So far a turn goes on past the last measurement.
constexpr std::int64_t kLongestExtrapolation_ns = 25'000'000;
// Consumer gyroscopes are switched on with such a bias; it wanders so fast (rad/s, and per square
// root of a second).
constexpr double kInitialBias_radps = 0.02;
constexpr double kBiasWalk = 1e-4;
// What turns are uncertain by besides: noise density and errors of scale and axes.
constexpr double kNoise_rad_rts = 3e-4;
constexpr double kScaleError = 0.01;

}  // namespace

ImuTrack::ImuTrack() : nodes_(kNodes), bias_sigma_radps_(kInitialBias_radps) {}

void ImuTrack::add(const ImuSample& sample) {
  Node next{.time = sample.gyro_time,
            .rate_radps = sample.angular_rate_radps - bias_radps_,
            .force_mps2 = sample.acceleration_mps2};
  if (count_ > 0) {
    const Node& last = node(0);
    const std::int64_t step_ns = next.time - last.time;
    if (step_ns == 0) return;
    if (step_ns < 0 || step_ns > kLongestGap_ns) {
      count_ = 0;
    } else {
      Node moved = last;
      advance(moved, 0.5 * (last.rate_radps + next.rate_radps),
              0.5 * (last.force_mps2 + next.force_mps2),
              static_cast<double>(step_ns) * kSecondsPerNs);
      next.rotation = moved.rotation;
      next.velocity_mps = moved.velocity_mps;
      next.way_m = moved.way_m;
    }
  }
  nodes_[next_] = next;
  next_ = (next_ + 1) % nodes_.size();
  count_ = std::min(count_ + 1, nodes_.size());
  // Gravity alone takes a body far in an hour: with the numbers their last digits would grow.
  if (next_ == 0) begin_at_rest();
}

// At constant rate and force, both in the body's own frame.
void ImuTrack::advance(Node& from, const Eigen::Vector3d& rate_radps,
                       const Eigen::Vector3d& force_mps2, double dt_s) {
  const Eigen::Quaterniond half = from.rotation * so3_exp(0.5 * dt_s * rate_radps);
  const Eigen::Vector3d gained_mps = half * (force_mps2 * dt_s);
  from.way_m += (from.velocity_mps + 0.5 * gained_mps) * dt_s;
  from.velocity_mps += gained_mps;
  from.rotation = (from.rotation * so3_exp(dt_s * rate_radps)).normalized();
}

// Seen from a body that moves as the oldest node does; motions between nodes stay as they are.
void ImuTrack::begin_at_rest() {
  const Node oldest = node(count_ - 1);
  for (std::size_t i = 0; i < count_; ++i) {
    Node& moved = nodes_[(next_ + nodes_.size() - 1 - i) % nodes_.size()];
    const double since_s = static_cast<double>(moved.time - oldest.time) * kSecondsPerNs;
    moved.way_m -= oldest.way_m + oldest.velocity_mps * since_s;
    moved.velocity_mps -= oldest.velocity_mps;
  }
}

std::optional<ImuMotion> ImuTrack::between(SensorTime a, SensorTime b) const {
  const auto at_a = state(a);
  const auto at_b = at_a ? state(b) : std::nullopt;
  if (!at_b) return std::nullopt;
  const double span_s = static_cast<double>(b - a) * kSecondsPerNs;
  const Eigen::Quaterniond to_a = at_a->rotation.conjugate();
  return ImuMotion{to_a * at_b->rotation, to_a * (at_b->velocity_mps - at_a->velocity_mps),
                   to_a * (at_b->way_m - at_a->way_m - at_a->velocity_mps * span_s)};
}

std::optional<ImuTrack::Node> ImuTrack::state(SensorTime t) const {
  if (count_ == 0 || t - node(0).time > kLongestExtrapolation_ns) return std::nullopt;
  // Those asked for are mostly among the newest.
  std::size_t back = 0;
  while (back + 1 < count_ && node(back).time - t > 0) ++back;
  Node at = node(back);
  if (at.time - t > kLongestExtrapolation_ns) return std::nullopt;
  const bool between = back > 0 && t - at.time > 0;
  const Node& after = between ? node(back - 1) : node(back);
  advance(at, 0.5 * (at.rate_radps + after.rate_radps), 0.5 * (at.force_mps2 + after.force_mps2),
          static_cast<double>(t - at.time) * kSecondsPerNs);
  return at;
}

double ImuTrack::turn_sigma_rad(double span_s, double turn_rad) const {
  const double bias_rad = bias_sigma_radps_ * span_s;
  const double scale_rad = kScaleError * turn_rad;
  return std::sqrt(bias_rad * bias_rad + kNoise_rad_rts * kNoise_rad_rts * span_s +
                   scale_rad * scale_rad);
}

// A Kalman filter for a bias that wanders, the same for each axis.
void ImuTrack::learn_bias(SensorTime a, SensorTime b, const Eigen::Quaterniond& R_a_b,
                          double sigma_rad) {
  const auto measured = between(a, b);
  const double span_s = static_cast<double>(b - a) * kSecondsPerNs;
  if (!measured || span_s <= 0.0) return;
  const Eigen::Quaterniond& turn = measured->turn;
  const Eigen::Vector3d found_radps = so3_log(R_a_b.conjugate() * turn) / span_s;
  const double since_s =
      learned_ ? std::clamp(static_cast<double>(b - *learned_) * kSecondsPerNs, 0.0, 60.0) : span_s;
  learned_ = b;
  const double turn_rad = so3_log(turn).norm();
  const double noise_radps =
      std::hypot(sigma_rad, kScaleError * turn_rad, kNoise_rad_rts * std::sqrt(span_s)) / span_s;
  const double variance = bias_sigma_radps_ * bias_sigma_radps_ + kBiasWalk * kBiasWalk * since_s;
  const double gain = variance / (variance + noise_radps * noise_radps);
  // A wrong registration must not spoil it.
  const double limit_radps = 5.0 * std::sqrt(variance + noise_radps * noise_radps);
  if (found_radps.norm() > limit_radps) return;
  bias_sigma_radps_ = std::sqrt((1.0 - gain) * variance);
  bias_radps_ += gain * found_radps;
}

}  // namespace glint::slam
