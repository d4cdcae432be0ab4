// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/planar_consensus.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint::slam {
namespace {

// Nearer ones say too little of the heading; in gates.
constexpr float kLeastBase = 10.0F;
// Of many pairs, this many are sampled: the first, which look most alike.
constexpr std::size_t kMostSampled = 60;
constexpr int kPlanarRefits = 3;

struct Planar {
  float cosine = 1.0F;
  float sine = 0.0F;
  Eigen::Vector2f shift_m = Eigen::Vector2f::Zero();

  [[nodiscard]] Eigen::Vector2f operator*(const Eigen::Vector2f& p) const {
    return {cosine * p.x() - sine * p.y() + shift_m.x(),
            sine * p.x() + cosine * p.y() + shift_m.y()};
  }
};

// The turn that best takes `current` to `reference`, each about its middle: from the sums of their
// scalar and cross products, so that it is a turn whatever the pairs are.
Planar fit(std::span<const PlanarPair> pairs) {
  Eigen::Vector2f reference_m = Eigen::Vector2f::Zero();
  Eigen::Vector2f current_m = Eigen::Vector2f::Zero();
  for (const PlanarPair& pair : pairs) {
    reference_m += pair.reference_m;
    current_m += pair.current_m;
  }
  reference_m /= static_cast<float>(pairs.size());
  current_m /= static_cast<float>(pairs.size());
  float dot = 0.0F;
  float cross = 0.0F;
  for (const PlanarPair& pair : pairs) {
    const Eigen::Vector2f r = pair.reference_m - reference_m;
    const Eigen::Vector2f c = pair.current_m - current_m;
    dot += r.dot(c);
    cross += c.x() * r.y() - c.y() * r.x();
  }
  const float length = std::max(std::hypot(dot, cross), 1e-12F);
  Planar planar{dot / length, cross / length, Eigen::Vector2f::Zero()};
  planar.shift_m = reference_m - planar * current_m;
  return planar;
}

int count_agreeing(std::span<const PlanarPair> pairs, const Planar& planar, float gate_m) {
  return static_cast<int>(std::ranges::count_if(pairs, [&](const PlanarPair& pair) {
    return (planar * pair.current_m - pair.reference_m).squaredNorm() < gate_m * gate_m;
  }));
}

}  // namespace

PlanarConsensus find_planar_consensus(std::span<const PlanarPair> pairs, float gate_m) {
  PlanarConsensus best;
  Planar found;
  const std::span<const PlanarPair> sampled = pairs.first(std::min(pairs.size(), kMostSampled));
  for (std::size_t a = 0; a < sampled.size(); ++a) {
    for (std::size_t b = a + 1; b < sampled.size(); ++b) {
      const float current_m = (sampled[a].current_m - sampled[b].current_m).norm();
      const float reference_m = (sampled[a].reference_m - sampled[b].reference_m).norm();
      if (current_m < kLeastBase * gate_m || std::abs(current_m - reference_m) > gate_m) continue;
      const Planar planar = fit(std::array{sampled[a], sampled[b]});
      const int agreeing = count_agreeing(pairs, planar, gate_m);
      if (agreeing <= best.inliers) continue;
      best.inliers = agreeing;
      found = planar;
    }
  }
  if (best.inliers < 3) return {};
  std::vector<PlanarPair> inliers;
  for (int i = 0; i < kPlanarRefits; ++i) {
    inliers.clear();
    for (const PlanarPair& pair : pairs) {
      if ((found * pair.current_m - pair.reference_m).squaredNorm() < gate_m * gate_m) {
        inliers.push_back(pair);
      }
    }
    if (inliers.size() < 3) return {};
    found = fit(inliers);
  }
  best.inliers = count_agreeing(pairs, found, gate_m);
  best.yaw_rad = std::atan2(static_cast<double>(found.sine), static_cast<double>(found.cosine));
  best.translation_m = found.shift_m.cast<double>();
  return best;
}

}  // namespace glint::slam
