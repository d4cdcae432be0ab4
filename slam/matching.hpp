// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/features.hpp"
#include "slam/nearest_descriptors.hpp"

namespace glint::slam {

/// Keypoint `current` of the new scan looks like keypoint `reference` of the older one.
struct Match {
  std::int32_t reference = 0;
  std::int32_t current = 0;
  std::int32_t distance = 0;  ///< Hamming distance of the descriptors, 0-256.
};

/// Hamming distance of two descriptors.
int hamming_distance(const Descriptor& a, const Descriptor& b);

struct MatchOptions {
  int max_distance = 64;
  double keep_share = 0.3;  ///< Of the keypoints of the smaller set, the best matches are kept.
  int max_matches = 200;
};

/// Brute-force matching of binary descriptors with cross-check, best first: pairs that are each
/// other's nearest, the best `keep_share` of them and at most `max_matches`
/// [Du & Beltrame 2023, sec. III-A; the shares are those of its published code].
/// Thread-compatible; buffers are reused between calls.
class Matcher {
 public:
  explicit Matcher(MatchOptions options) : options_(options) {}
  const std::vector<Match>& match(std::span<const Descriptor> reference,
                                  std::span<const Descriptor> current);

 private:
  MatchOptions options_;
  NearestDescriptors nearest_;
  std::vector<Match> matches_;
};

/// Weight S_n of a match in the registration: falls with the Hamming distance, in [0.05, 1].
/// The paper names S_n without a formula; this one is linear, zero similarity at distance 80.
double match_score(int hamming_distance);

}  // namespace glint::slam
