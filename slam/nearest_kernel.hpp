// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace glint::slam::kernel {

constexpr std::size_t kDescriptorBytes = 32;
/// Distances are kept in a byte: descriptors this far apart, or farther, are nobody's nearest.
constexpr int kFarthest = 255;

/// What is compared with what, and where the answers go. Plain pointers: a file compiled for newer
/// processors must not instantiate a library's inline functions, for the linker might give those to
/// everyone.
struct NearestTask {
  /// The references by blocks of as many as a vector has lanes; of a block all first bytes, all
  /// second bytes, and so on. Aligned to 64 bytes.
  const std::uint8_t* slices;
  std::size_t references;
  const std::uint8_t* current;  ///< kDescriptorBytes each.
  std::size_t currents;
  std::uint8_t* reference_distance;  ///< kFarthest each to begin with; whole blocks.
  std::int32_t* reference_partner;
  std::uint8_t* current_distance;
  std::int32_t* current_partner;  ///< -1: none.
};

/// The nearest in both directions in one pass over all pairs; the first wins a tie. A vector's
/// lanes hold the distances of one current descriptor to as many references.
template <class Vector>
[[gnu::always_inline]] inline void nearest_both_ways(const NearestTask& task) {
  using Bytes = typename Vector::Bytes;
  constexpr std::size_t kLanes = Vector::kLanes;
  const std::size_t blocks = (task.references + kLanes - 1) / kLanes;
  const std::size_t in_last = task.references - (blocks - 1) * kLanes;
  const std::uint64_t last_lanes = ~std::uint64_t{0} >> (64 - in_last);
  for (std::size_t c = 0; c < task.currents; ++c) {
    Bytes current[kDescriptorBytes];
    for (std::size_t j = 0; j < kDescriptorBytes; ++j) {
      current[j] = Vector::all(task.current[c * kDescriptorBytes + j]);
    }
    int best = kFarthest;
    std::int32_t partner = -1;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint8_t* const slice = task.slices + b * kDescriptorBytes * kLanes;
      Bytes distance = Vector::all(0);
      for (std::size_t j = 0; j < kDescriptorBytes; ++j) {
        distance = Vector::add_ones(distance, Vector::load(slice + j * kLanes), current[j]);
      }
      std::uint8_t* const of_references = task.reference_distance + b * kLanes;
      const Bytes before = Vector::load(of_references);
      const std::uint64_t lanes = b + 1 == blocks ? last_lanes : ~std::uint64_t{0};
      std::uint64_t nearer = Vector::less(distance, before) & lanes;
      std::uint64_t best_here =
          Vector::less(distance, Vector::all(static_cast<std::uint8_t>(best))) & lanes;
      if ((nearer | best_here) == 0) continue;
      Vector::store(Vector::least(distance, before), of_references);
      for (; nearer != 0; nearer &= nearer - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctzll(nearer));
        task.reference_partner[b * kLanes + lane] = static_cast<std::int32_t>(c);
      }
      alignas(64) std::uint8_t distances[kLanes];
      Vector::store(distance, distances);
      for (; best_here != 0; best_here &= best_here - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctzll(best_here));
        if (distances[lane] >= best) continue;
        best = distances[lane];
        partner = static_cast<std::int32_t>(b * kLanes + lane);
      }
    }
    task.current_distance[c] = static_cast<std::uint8_t>(best);
    task.current_partner[c] = partner;
  }
}

void nearest_avx2(const NearestTask& task);
void nearest_avx512(const NearestTask& task);

}  // namespace glint::slam::kernel
