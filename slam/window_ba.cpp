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
    for (const Frame& frame : frames_) {
      // Position first: it is cheap and leaves few to compare.
      int best_bits = options_.max_hamming_bits + 1;
      std::size_t best = 0;
      for (const std::size_t i : near(frame, here_m)) {
        const int bits = hamming_distance(frame.descriptors[i], current.descriptors[c]);
        if (bits >= best_bits) continue;
        best_bits = bits;
        best = i;
      }
      if (best_bits > options_.max_hamming_bits) continue;
      const double score = match_score(best_bits);
      terms_.push_back({current.points_m[c], frame.fixed_m[best], score * score});
    }
  }
  return terms_;
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
