// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Compiled for AVX2 and called only where the processor has it.
#include <immintrin.h>

#include "slam/nearest_kernel.hpp"

namespace glint::slam::kernel {
namespace {

struct Avx2Vector {
  static constexpr std::size_t kLanes = 32;
  using Bytes = __m256i;

  static Bytes all(std::uint8_t value) { return _mm256_set1_epi8(static_cast<char>(value)); }
  static Bytes load(const std::uint8_t* at) {
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(at));
  }
  static void store(Bytes bytes, std::uint8_t* at) {
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), bytes);
  }
  static Bytes least(Bytes a, Bytes b) { return _mm256_min_epu8(a, b); }
  static std::uint64_t less(Bytes a, Bytes b) {
    const __m256i not_less = _mm256_cmpeq_epi8(_mm256_max_epu8(a, b), a);
    return static_cast<std::uint32_t>(~_mm256_movemask_epi8(not_less));
  }
  // Ones of half a byte, looked up.
  static Bytes add_ones(Bytes sum, Bytes a, Bytes b) {
    const __m256i ones = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                          0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
    const __m256i half = _mm256_set1_epi8(0x0F);
    const __m256i differ = _mm256_xor_si256(a, b);
    const __m256i low = _mm256_and_si256(differ, half);
    const __m256i high = _mm256_and_si256(_mm256_srli_epi16(differ, 4), half);
    const __m256i in_byte =
        _mm256_add_epi8(_mm256_shuffle_epi8(ones, low), _mm256_shuffle_epi8(ones, high));
    return _mm256_adds_epu8(sum, in_byte);
  }
};

}  // namespace

void nearest_avx2(const NearestTask& task) { nearest_both_ways<Avx2Vector>(task); }

}  // namespace glint::slam::kernel
