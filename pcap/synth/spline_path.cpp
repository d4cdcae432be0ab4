// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/spline_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint::synth {
namespace {

constexpr int kDegree = 5;
// Steps per segment in which the length is summed up.
constexpr int kLengthSteps = 16;

// The degree + 1 basis functions that are not zero at fraction t of a segment, by the recurrence of
// Cox and de Boor on a uniform knot vector.
std::array<double, kDegree + 1> basis(double t, int degree) {
  std::array<double, kDegree + 1> b{1.0};
  for (int d = 1; d <= degree; ++d) {
    double carried = 0.0;
    for (int i = 0; i < d; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double share = b[k] / d;
      b[k] = carried + (i + 1 - t) * share;
      carried = (t + d - 1 - i) * share;
    }
    b[static_cast<std::size_t>(d)] = carried;
  }
  return b;
}

}  // namespace

SplinePath::SplinePath(std::vector<Eigen::Vector2d> control_points_m, bool closed)
    : points_m_(std::move(control_points_m)), closed_(closed) {
  const int count = static_cast<int>(points_m_.size());
  segments_ = closed ? count : count - kDegree;
  Eigen::Vector2d before;
  Eigen::Vector2d tangent;
  evaluate(0.0, before, tangent);
  for (int i = 1; i <= segments_ * kLengthSteps; ++i) {
    Eigen::Vector2d here;
    evaluate(static_cast<double>(i) / kLengthSteps, here, tangent);
    length_m_ += (here - before).norm();
    before = here;
  }
}

const Eigen::Vector2d& SplinePath::control(int index) const {
  const int count = static_cast<int>(points_m_.size());
  return points_m_[static_cast<std::size_t>(closed_ ? index % count : std::min(index, count - 1))];
}

void SplinePath::evaluate(double parameter, Eigen::Vector2d& position_m,
                          Eigen::Vector2d& tangent) const {
  const int segment = std::clamp(static_cast<int>(std::floor(parameter)), 0, segments_ - 1);
  const double t = parameter - segment;
  const auto weight = basis(t, kDegree);
  // The derivative is a spline of one degree less through the differences of the points.
  const auto slope = basis(t, kDegree - 1);
  position_m.setZero();
  tangent.setZero();
  for (int i = 0; i <= kDegree; ++i) {
    position_m += weight[static_cast<std::size_t>(i)] * control(segment + i);
    if (i < kDegree) {
      tangent +=
          slope[static_cast<std::size_t>(i)] * (control(segment + i + 1) - control(segment + i));
    }
  }
}

PathPoint SplinePath::at(double way_m) const {
  const double parameter = way_m / length_m_ * segments_;
  const double wrapped =
      closed_ ? parameter - segments_ * std::floor(parameter / segments_) : parameter;
  Eigen::Vector2d position_m;
  Eigen::Vector2d tangent;
  evaluate(wrapped, position_m, tangent);
  return {position_m.x(), position_m.y(), std::atan2(tangent.y(), tangent.x())};
}

}  // namespace glint::synth
