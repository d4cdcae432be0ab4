// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Compiled for AVX2 and called only where the processor has it.
#include <immintrin.h>

#include "driver/core/column_kernel.hpp"

namespace glint::kernel {
namespace {

struct Avx2Vector {
  static constexpr std::size_t kLanes = 8;
  typedef std::uint32_t Words __attribute__((vector_size(32)));
  using Row = WordRow<Avx2Vector>;

  static Words load(const std::byte* at, std::size_t stride) {
    return words(
        _mm256_inserti128_si256(_mm256_castsi128_si256(quad(at)), quad(at + 8 * stride), 1));
  }
  static Words interleave_low(Words a, Words b) {
    return words(_mm256_unpacklo_epi32(raw(a), raw(b)));
  }
  static Words interleave_high(Words a, Words b) {
    return words(_mm256_unpackhi_epi32(raw(a), raw(b)));
  }
  static Words join_low(Words a, Words b) { return words(_mm256_unpacklo_epi64(raw(a), raw(b))); }
  static Words join_high(Words a, Words b) { return words(_mm256_unpackhi_epi64(raw(a), raw(b))); }

  static void store(const Row& row, std::uint32_t* out) {
    const __m256i a = raw(row.part[0]);
    const __m256i b = raw(row.part[1]);
    put(_mm256_permute2x128_si256(a, b, 0x20), out);
    put(_mm256_permute2x128_si256(a, b, 0x31), out + kLanes);
  }
  static void store(const Row& row, std::uint16_t* out) {
    put(_mm256_packus_epi32(raw(row.part[0]), raw(row.part[1])), out);
  }

 private:
  static __m256i raw(Words words) { return reinterpret_cast<__m256i>(words); }
  static Words words(__m256i raw) { return reinterpret_cast<Words>(raw); }
  static __m128i quad(const std::byte* at) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
  }
  template <class T>
  static void put(__m256i vector, T* out) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), vector);
  }
};

template <std::size_t... kProfiles>
DecodeBlock pick(std::size_t profile, std::index_sequence<kProfiles...>) {
  static constexpr DecodeBlock kDecoders[] = {&BlockDecoder<kProfiles, Avx2Vector>::decode...};
  return kDecoders[profile];
}

}  // namespace

DecodeBlock avx2_block_decoder(std::size_t profile) {
  return pick(profile, std::make_index_sequence<kProfileTable.size()>());
}

}  // namespace glint::kernel
