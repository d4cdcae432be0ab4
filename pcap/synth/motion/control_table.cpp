// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/control_table.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "pcap/synth/motion/quintic_spline.hpp"

namespace glint::synth {

ControlTable::ControlTable(std::vector<Control> controls, std::size_t repeat_from,
                           double interval_s, double turn_rad)
    : controls_(std::move(controls)),
      repeat_from_(static_cast<std::int64_t>(repeat_from)),
      interval_s_(interval_s),
      turn_rad_(turn_rad) {}

Control ControlTable::control(std::int64_t index) const {
  if (index < repeat_from_) return controls_[index < 0 ? 0 : static_cast<std::size_t>(index)];
  const auto round = static_cast<std::int64_t>(controls_.size()) - repeat_from_;
  const std::int64_t since = index - repeat_from_;
  Control control = controls_[static_cast<std::size_t>(repeat_from_ + since % round)];
  const std::int64_t rounds = since / round;
  control[kHeading] += turn_rad_ * static_cast<double>(rounds);
  return control;
}

Control ControlTable::at(double t_s) const {
  const double place = t_s / interval_s_;
  const double interval = std::floor(place);
  const auto weights = spline_weights(place - interval);
  const auto index = static_cast<std::int64_t>(interval);
  // As a sum of differences: where all control points are alike, nothing moves by a rounding error.
  const Control here = control(index);
  Control sum = here;
  for (int i = 0; i < kSplineSupport; ++i) {
    sum += weights[static_cast<std::size_t>(i)] * (control(index - kSplineBefore + i) - here);
  }
  return sum;
}

}  // namespace glint::synth
