// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/matching.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace glint::slam {

int hamming_distance(const Descriptor& a, const Descriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

double match_score(int hamming_distance) {
  return std::clamp(1.0 - static_cast<double>(hamming_distance) / 80.0, 0.05, 1.0);
}

const std::vector<Match>& Matcher::match(std::span<const Descriptor> reference,
                                         std::span<const Descriptor> current) {
  nearest_.find(reference, current);
  const auto& [partner, distance] = nearest_.of_current();
  matches_.clear();
  for (std::size_t c = 0; c < current.size(); ++c) {
    if (partner[c] < 0 || distance[c] > options_.max_distance) continue;
    const auto r = static_cast<std::size_t>(partner[c]);
    const auto own = static_cast<std::int32_t>(c);
    if (nearest_.of_reference().partner[r] != own) continue;
    matches_.push_back({partner[c], own, distance[c]});
  }
  std::stable_sort(matches_.begin(), matches_.end(),
                   [](const Match& a, const Match& b) { return a.distance < b.distance; });
  const double smaller = static_cast<double>(std::min(reference.size(), current.size()));
  const auto share = static_cast<std::size_t>(std::ceil(options_.keep_share * smaller));
  const auto most = std::min(share, static_cast<std::size_t>(options_.max_matches));
  if (matches_.size() > most) matches_.resize(most);
  return matches_;
}

}  // namespace glint::slam
