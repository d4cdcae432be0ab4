// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/features.hpp"

namespace glint::slam {

/// How the nearest are looked for; the results are the same.
enum class NearestPath { kPortable, kAvx2, kAvx512 };

/// The paths that this processor has, the fastest last.
std::vector<NearestPath> nearest_paths();

/// Of each descriptor the nearest one of another set by Hamming distance, in both directions, by
/// comparing all with all. The first wins a tie; descriptors that differ in 255 bits or more are
/// nobody's nearest. Thread-compatible; buffers are reused between calls.
class NearestDescriptors {
 public:
  struct Nearest {
    std::vector<std::int32_t> partner;   ///< In the other set; -1: none.
    std::vector<std::uint8_t> distance;  ///< Bits.
  };

  NearestDescriptors() : NearestDescriptors(nearest_paths().back()) {}
  explicit NearestDescriptors(NearestPath path) : path_(path) {}

  void find(std::span<const Descriptor> reference, std::span<const Descriptor> current);
  [[nodiscard]] const Nearest& of_reference() const { return of_reference_; }
  [[nodiscard]] const Nearest& of_current() const { return of_current_; }

 private:
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };

  void slice(std::span<const Descriptor> reference, std::size_t lanes);

  NearestPath path_;
  Nearest of_reference_;
  Nearest of_current_;
  std::vector<Line> slices_;
  std::vector<Line> reference_distance_;
};

}  // namespace glint::slam
