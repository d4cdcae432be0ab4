// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/window_ba.hpp"

#include <utility>

namespace glint::slam {

const std::vector<PointTerm>& SlidingWindow::associate(const Features& current,
                                                       const std::vector<Match>& front_end_matches,
                                                       const Pose& T_odom_scan) {
  terms_.clear();
  for (const Match& match : front_end_matches) {
    const auto c = static_cast<std::size_t>(match.current);
    const Eigen::Vector3d here_m = T_odom_scan * current.points_m[c];
    double weights = 0.0;
    Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
    for (const Frame& frame : frames_) {
      Eigen::Vector3d fixed_m = Eigen::Vector3d::Zero();
      const double weight = look_for(current.descriptors[c], here_m, frame, fixed_m);
      if (weight <= 0.0) continue;
      if (!options_.means) terms_.push_back({current.points_m[c], fixed_m, weight});
      weights += weight;
      sum_m += weight * fixed_m;
    }
    if (!options_.means || weights <= 0.0) continue;
    // As good as the current scan's half of it, however many frames the other half comes from.
    terms_.push_back({current.points_m[c], sum_m / weights, weights / (0.5 + 0.5 * weights)});
  }
  return terms_;
}

double SlidingWindow::look_for(const Descriptor& descriptor, const Eigen::Vector3d& place_m,
                               const Frame& frame, Eigen::Vector3d& fixed_m) {
  // Position first: it is cheap and leaves few to compare.
  int best_bits = options_.max_hamming_bits + 1;
  for (const std::size_t i : near(frame, place_m)) {
    const int bits = hamming_distance(frame.descriptors[i], descriptor);
    if (bits >= best_bits) continue;
    best_bits = bits;
    fixed_m = frame.fixed_m[i];
  }
  if (best_bits > options_.max_hamming_bits) return 0.0;
  const double score = match_score(best_bits);
  return score * score;
}

// A loop for the compiler to vectorise, then the few that are near.
const std::vector<std::size_t>& SlidingWindow::near(const Frame& frame,
                                                    const Eigen::Vector3d& place_m) {
  const std::size_t size = frame.fixed_m.size();
  squared_.resize(size);
  const Eigen::Vector3f here = place_m.cast<float>();
  const float* const x = frame.x_m.data();
  const float* const y = frame.y_m.data();
  const float* const z = frame.z_m.data();
  float* const squared = squared_.data();
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = x[i] - here.x();
    const float dy = y[i] - here.y();
    const float dz = z[i] - here.z();
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
  const auto gate2 = static_cast<float>(options_.gate_m * options_.gate_m);
  near_.clear();
  for (std::size_t i = 0; i < size; ++i) {
    if (squared[i] <= gate2) near_.push_back(i);
  }
  return near_;
}

void SlidingWindow::push(const Features& current, const std::vector<Match>& front_end_matches,
                         const Pose& T_odom_scan) {
  // The oldest frame's buffers are used again.
  Frame frame;
  if (frames_.size() >= static_cast<std::size_t>(options_.frames) && !frames_.empty()) {
    frame = std::move(frames_.front());
    frames_.pop_front();
  }
  frame.descriptors.clear();
  frame.fixed_m.clear();
  frame.x_m.clear();
  frame.y_m.clear();
  frame.z_m.clear();
  for (const Match& match : front_end_matches) {
    const auto c = static_cast<std::size_t>(match.current);
    frame.descriptors.push_back(current.descriptors[c]);
    const Eigen::Vector3d fixed_m = T_odom_scan * current.points_m[c];
    frame.fixed_m.push_back(fixed_m);
    frame.x_m.push_back(static_cast<float>(fixed_m.x()));
    frame.y_m.push_back(static_cast<float>(fixed_m.y()));
    frame.z_m.push_back(static_cast<float>(fixed_m.z()));
  }
  frames_.push_back(std::move(frame));
}

}  // namespace glint::slam
