// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/crc64.hpp"

#include <array>

#include "driver/core/bytes.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace glint {
namespace {

constexpr std::uint64_t kReversedPolynomial = 0xC96C'5795'D787'0F42;
constexpr std::uint64_t kAllOnes = ~std::uint64_t{0};

// Polynomials are reflected: bit 63 is x^0.
constexpr std::uint64_t times_x(std::uint64_t value) {
  return value >> 1U ^ ((value & 1U) != 0 ? kReversedPolynomial : 0);
}

// kTables[n][b]: the remainder of byte b with n zero bytes after it ("slicing by 8").
constexpr auto kTables = [] {
  std::array<std::array<std::uint64_t, 256>, 8> tables{};
  for (std::size_t i = 0; i < 256; ++i) {
    std::uint64_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = times_x(crc);
    tables[0][i] = crc;
  }
  for (std::size_t n = 1; n < tables.size(); ++n) {
    for (std::size_t i = 0; i < 256; ++i) {
      const std::uint64_t before = tables[n - 1][i];
      tables[n][i] = before >> 8U ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}();

std::uint64_t update(std::uint64_t crc, const std::byte* from, std::size_t size) {
  for (; size >= 8; size -= 8, from += 8) {
    const std::uint64_t word = crc ^ load<std::uint64_t>(from);
    crc = 0;
    for (unsigned n = 0; n < 8; ++n) crc ^= kTables[7 - n][word >> 8 * n & 0xFFU];
  }
  for (; size > 0; --size, ++from) {
    crc = crc >> 8U ^ kTables[0][(crc ^ static_cast<std::uint64_t>(*from)) & 0xFFU];
  }
  return crc;
}

#if defined(__x86_64__)

constexpr std::uint64_t x_to_the(int power) {
  std::uint64_t value = std::uint64_t{1} << 63U;
  for (int i = 0; i < power; ++i) value = times_x(value);
  return value;
}

// The block `kBits` further on that has the same remainder, as polynomials: low * x^(kBits + 64) +
// high * x^kBits. A carry-less product of reflected numbers has a factor x of its own.
template <int kBits>
__attribute__((target("pclmul"))) inline __m128i fold(__m128i block) {
  constexpr std::uint64_t kLow = x_to_the(kBits + 64 - 1);
  constexpr std::uint64_t kHigh = x_to_the(kBits - 1);
  const __m128i factors =
      _mm_set_epi64x(static_cast<long long>(kHigh), static_cast<long long>(kLow));
  return _mm_xor_si128(_mm_clmulepi64_si128(block, factors, 0x00),
                       _mm_clmulepi64_si128(block, factors, 0x11));
}

// Folds four blocks at a time into those behind them, then those four into one, whose remainder is
// that of all before it [Gopal et al., Fast CRC Computation Using PCLMULQDQ, 2009].
__attribute__((target("pclmul"))) std::uint64_t update_by_folding(std::uint64_t crc,
                                                                  const std::byte* from,
                                                                  std::size_t size) {
  constexpr std::size_t kBlock = 16;
  constexpr std::size_t kStride = 4 * kBlock;
  if (size < 2 * kStride) return update(crc, from, size);
  const auto block = [&](std::size_t i) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i * kBlock));
  };
  __m128i a = _mm_xor_si128(block(0), _mm_set_epi64x(0, static_cast<long long>(crc)));
  __m128i b = block(1);
  __m128i c = block(2);
  __m128i d = block(3);
  for (from += kStride, size -= kStride; size >= kStride; from += kStride, size -= kStride) {
    a = _mm_xor_si128(fold<512>(a), block(0));
    b = _mm_xor_si128(fold<512>(b), block(1));
    c = _mm_xor_si128(fold<512>(c), block(2));
    d = _mm_xor_si128(fold<512>(d), block(3));
  }
  b = _mm_xor_si128(fold<128>(a), b);
  c = _mm_xor_si128(fold<128>(b), c);
  d = _mm_xor_si128(fold<128>(c), d);
  std::array<std::byte, kBlock> last;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(last.data()), d);
  return update(update(0, last.data(), last.size()), from, size);
}

#endif

}  // namespace

std::uint64_t crc64_portable(std::span<const std::byte> bytes) {
  return ~update(kAllOnes, bytes.data(), bytes.size());
}

std::uint64_t crc64(std::span<const std::byte> bytes) {
#if defined(__x86_64__)
  static const bool kFolds = __builtin_cpu_supports("pclmul") != 0;
  if (kFolds) return ~update_by_folding(kAllOnes, bytes.data(), bytes.size());
#endif
  return crc64_portable(bytes);
}

}  // namespace glint
