// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Compiled for AVX-512 with BITALG and called only where the processor has it.
#include <immintrin.h>

#include "slam/nearest_kernel.hpp"

namespace glint::slam::kernel {
namespace {

struct Avx512Vector {
  static constexpr std::size_t kLanes = 64;
  using Bytes = __m512i;

  static Bytes all(std::uint8_t value) { return _mm512_set1_epi8(static_cast<char>(value)); }
  static Bytes load(const std::uint8_t* at) { return _mm512_load_si512(at); }
  static void store(Bytes bytes, std::uint8_t* at) { _mm512_store_si512(at, bytes); }
  static Bytes least(Bytes a, Bytes b) { return _mm512_min_epu8(a, b); }
  static std::uint64_t less(Bytes a, Bytes b) { return _mm512_cmplt_epu8_mask(a, b); }
  static Bytes add_ones(Bytes sum, Bytes a, Bytes b) {
    return _mm512_adds_epu8(sum, _mm512_popcnt_epi8(_mm512_xor_si512(a, b)));
  }
};

}  // namespace

void nearest_avx512(const NearestTask& task) { nearest_both_ways<Avx512Vector>(task); }

}  // namespace glint::slam::kernel
