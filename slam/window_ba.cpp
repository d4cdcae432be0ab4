// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/window_ba.hpp"

#include <utility>

namespace glint::slam {

const std::vector<PointTerm>& SlidingWindow::associate(const Features& current,
                                                       const std::vector<Match>& front_end_matches,
                                                       const Pose& T_odom_scan) {
  terms_.clear();
  const double gate2 = options_.gate_m * options_.gate_m;
  for (const Match& match : front_end_matches) {
    const auto c = static_cast<std::size_t>(match.current);
    const Eigen::Vector3d here_m = T_odom_scan * current.points_m[c];
    for (const Frame& frame : frames_) {
      // Position first: it is cheap and leaves few to compare.
      int best_bits = options_.max_hamming_bits + 1;
      std::size_t best = 0;
      for (std::size_t i = 0; i < frame.fixed_m.size(); ++i) {
        if ((frame.fixed_m[i] - here_m).squaredNorm() > gate2) continue;
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
  for (const Match& match : front_end_matches) {
    const auto c = static_cast<std::size_t>(match.current);
    frame.descriptors.push_back(current.descriptors[c]);
    frame.fixed_m.push_back(T_odom_scan * current.points_m[c]);
  }
  frames_.push_back(std::move(frame));
}

}  // namespace glint::slam
