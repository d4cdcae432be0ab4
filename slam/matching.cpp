// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/matching.hpp"

#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

// 1000 x 1000 descriptors are a million distances: 7 ms with the baseline instruction set's
// bit-twiddling, 1 ms with the popcnt instruction. Same results either way.
#if defined(__x86_64__)
#define GLINT_POPCNT __attribute__((target("popcnt")))
bool have_popcnt() { return __builtin_cpu_supports("popcnt") != 0; }
#else
#define GLINT_POPCNT
bool have_popcnt() { return true; }
#endif

using Nearest = void(const std::vector<Descriptor>&, const std::vector<Descriptor>&,
                     std::vector<Match>&, std::vector<Match>&);

__attribute__((always_inline)) inline int distance(const Descriptor& a, const Descriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += __builtin_popcountll(a[i] ^ b[i]);
  return bits;
}

// One pass over all pairs gives the nearest neighbours in both directions; the first wins a tie.
__attribute__((always_inline)) inline void nearest_both_ways(
    const std::vector<Descriptor>& reference, const std::vector<Descriptor>& current,
    std::vector<Match>& of_reference, std::vector<Match>& of_current) {
  for (std::size_t c = 0; c < current.size(); ++c) {
    const Descriptor d = current[c];
    Match best{-1, static_cast<std::int32_t>(c), 257};
    for (std::size_t r = 0; r < reference.size(); ++r) {
      const int bits = distance(reference[r], d);
      if (bits < best.distance) {
        best.distance = bits;
        best.reference = static_cast<std::int32_t>(r);
      }
      if (bits < of_reference[r].distance) {
        of_reference[r].distance = bits;
        of_reference[r].current = static_cast<std::int32_t>(c);
      }
    }
    of_current[c] = best;
  }
}

GLINT_POPCNT void nearest_popcnt(const std::vector<Descriptor>& reference,
                                 const std::vector<Descriptor>& current,
                                 std::vector<Match>& of_reference, std::vector<Match>& of_current) {
  nearest_both_ways(reference, current, of_reference, of_current);
}

void nearest_portable(const std::vector<Descriptor>& reference,
                      const std::vector<Descriptor>& current, std::vector<Match>& of_reference,
                      std::vector<Match>& of_current) {
  nearest_both_ways(reference, current, of_reference, of_current);
}

}  // namespace

int hamming_distance(const Descriptor& a, const Descriptor& b) { return distance(a, b); }

double match_score(int hamming_distance) {
  return std::clamp(1.0 - static_cast<double>(hamming_distance) / 80.0, 0.05, 1.0);
}

const std::vector<Match>& Matcher::match(const std::vector<Descriptor>& reference,
                                         const std::vector<Descriptor>& current) {
  static Nearest* const nearest = have_popcnt() ? nearest_popcnt : nearest_portable;
  best_of_reference_.assign(reference.size(), Match{0, -1, 257});
  best_of_current_.assign(current.size(), Match{});
  nearest(reference, current, best_of_reference_, best_of_current_);

  matches_.clear();
  for (const Match& match : best_of_current_) {
    if (match.reference < 0 || match.distance > options_.max_distance) continue;
    const auto r = static_cast<std::size_t>(match.reference);
    if (best_of_reference_[r].current == match.current) matches_.push_back(match);
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
