// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/density_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint::slam {
namespace {

constexpr int kMostBitsApart = 60;
// Matched corners that turn by the same angle, in bins; two neighbouring ones count.
constexpr std::size_t kTurnBins = 24;
constexpr int kFewestTurning = 6;
// Of these maps the corners' places are compared.
constexpr std::size_t kMostCompared = 6;
constexpr int kFewestCorners = 8;
// In cells.
constexpr float kGate = 2.5F;

std::size_t turn_bin(float older_rad, float current_rad) {
  const double turns = (older_rad - current_rad) / (2.0 * M_PI);
  return static_cast<std::size_t>((turns - std::floor(turns)) * kTurnBins) % kTurnBins;
}

}  // namespace

DensityIndex::Turning DensityIndex::match(std::size_t entry, const DensityMap& current) {
  const DensityMap& older = maps_[entry];
  Turning turning;
  turning.entry = entry;
  if (older.cell_m != current.cell_m) return turning;
  nearest_.find(older.descriptors, current.descriptors);
  const NearestDescriptors::Nearest& of_older = nearest_.of_reference();
  const NearestDescriptors::Nearest& of_current = nearest_.of_current();
  std::array<int, kTurnBins> bins{};
  std::vector<std::pair<int, PlanarPair>> pairs;
  for (std::size_t c = 0; c < current.descriptors.size(); ++c) {
    const int bits = of_current.distance[c];
    if (of_current.partner[c] < 0 || bits > kMostBitsApart) continue;
    const auto r = static_cast<std::size_t>(of_current.partner[c]);
    if (of_older.partner[r] != static_cast<std::int32_t>(c)) continue;
    ++bins[turn_bin(older.angle_rad[r], current.angle_rad[c])];
    pairs.push_back({bits, {older.at_m[r], current.at_m[c]}});
  }
  for (std::size_t bin = 0; bin < kTurnBins; ++bin) {
    turning.corners = std::max(turning.corners, bins[bin] + bins[(bin + 1) % kTurnBins]);
  }
  if (turning.corners < kFewestTurning) return turning;
  std::ranges::stable_sort(pairs, {}, &std::pair<int, PlanarPair>::first);
  for (const auto& [bits, pair] : pairs) turning.pairs.push_back(pair);
  return turning;
}

std::vector<DensityHit> DensityIndex::query(const DensityMap& current,
                                            std::span<const std::size_t> asked) {
  std::vector<Turning> turning;
  for (const std::size_t entry : asked) {
    Turning found = match(entry, current);
    if (found.corners >= kFewestTurning) turning.push_back(std::move(found));
  }
  std::ranges::stable_sort(turning, std::ranges::greater{}, &Turning::corners);
  if (turning.size() > kMostCompared) turning.resize(kMostCompared);
  std::vector<DensityHit> hits;
  for (const Turning& found : turning) {
    const PlanarConsensus planar = find_planar_consensus(found.pairs, kGate * current.cell_m);
    if (planar.inliers < kFewestCorners) continue;
    DensityHit hit;
    hit.entry = found.entry;
    hit.corners = planar.inliers;
    hit.T_older_current.rotation = so3_exp({0.0, 0.0, planar.yaw_rad});
    hit.T_older_current.translation_m << planar.translation_m,
        static_cast<double>(maps_[found.entry].floor_m - current.floor_m);
    hits.push_back(hit);
  }
  std::ranges::stable_sort(hits, std::ranges::greater{}, &DensityHit::corners);
  return hits;
}

}  // namespace glint::slam
