// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/gravity.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr std::int64_t kBlock_ns = 500'000'000;
constexpr std::int64_t kLongestGap_ns = 100'000'000;
// Fewer say little of the scatter.
constexpr int kFewest = 10;
// At rest: the gyroscope shows no more than its noise and bias, the accelerometer little more than
// the spinning motor, and both together gravity.
constexpr double kRestRate_radps = 0.1;
constexpr double kRestRateScatter_radps = 0.03;
constexpr double kRestScatter_mps2 = 0.7;
constexpr double kGravity_mps2 = 9.81;
constexpr double kRestGravityError_mps2 = 0.7;
// Share of a new block in the mean.
constexpr double kGain = 0.2;

// Root of the mean squared distance to the mean.
double scatter(const Eigen::Vector3d& mean, double sum_squared, int count) {
  return std::sqrt(std::max(0.0, sum_squared / count - mean.squaredNorm()));
}

}  // namespace

void GravityEstimate::add(const ImuSample& sample) {
  const std::int64_t gap_ns = sample.accel_time - block_.end;
  if (block_.count > 0 && (gap_ns < 0 || gap_ns > kLongestGap_ns)) block_ = {};
  if (block_.count > 0 && sample.accel_time - block_.begin >= kBlock_ns) {
    block_.end = sample.accel_time;
    close_block();
    block_ = {};
  }
  if (block_.count == 0) block_.begin = sample.accel_time;
  block_.end = sample.accel_time;
  ++block_.count;
  block_.acceleration += sample.acceleration_mps2;
  block_.rate += sample.angular_rate_radps;
  block_.acceleration_squared += sample.acceleration_mps2.squaredNorm();
  block_.rate_squared += sample.angular_rate_radps.squaredNorm();
}

void GravityEstimate::close_block() {
  const int n = block_.count;
  rate_hz_ = n / (static_cast<double>(block_.end - block_.begin) * kSecondsPerNs);
  if (n < kFewest) return;
  const Eigen::Vector3d up = block_.acceleration / n;
  const Eigen::Vector3d rate = block_.rate / n;
  const bool rests = rate.norm() < kRestRate_radps &&
                     scatter(rate, block_.rate_squared, n) < kRestRateScatter_radps &&
                     scatter(up, block_.acceleration_squared, n) < kRestScatter_mps2 &&
                     std::abs(up.norm() - kGravity_mps2) < kRestGravityError_mps2;
  if (rests) up_mps2_ = up_mps2_ ? Eigen::Vector3d(*up_mps2_ + kGain * (up - *up_mps2_)) : up;
}

double mount_tilt_deg(const Eigen::Vector3d& up, const Eigen::Quaterniond& R_base_sensor) {
  const double cosine = (R_base_sensor * up).normalized().z();
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * (180.0 / M_PI);
}

}  // namespace glint
