// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace glint::synth {

/// A random number that depends on its keys only, so that results do not depend on the order in
/// which threads ask (SplitMix64 over the keys).
inline std::uint64_t hash_keys(std::initializer_list<std::uint64_t> keys) {
  std::uint64_t h = 0x9E3779B97F4A7C15ULL;
  for (const std::uint64_t key : keys) {
    h ^= key + 0x9E3779B97F4A7C15ULL + (h << 6) + (h >> 2);
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
    h ^= h >> 31;
  }
  return h;
}

/// A sequence of random numbers that starts from keys. Value type.
class Random {
 public:
  Random(std::initializer_list<std::uint64_t> keys) : state_(hash_keys(keys)) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// 0 ... count - 1.
  int below(int count) { return static_cast<int>(uniform() * count); }
  bool chance(double probability) { return uniform() < probability; }
  /// 64 random bits, e.g. as another sequence's key.
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  /// Normal with mean 0 and standard deviation 1 (Box-Muller).
  double gaussian() {
    const double u = 1.0 - uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * uniform());
  }
  /// Nearly normal, mean 0 and standard deviation 1, never beyond 4.9, in steps of 1/209: the sum
  /// of eight 8-bit numbers, for what is needed millions of times a second.
  double quick_gaussian() {
    constexpr std::uint64_t kEven = 0x00FF00FF00FF00FFULL;
    const std::uint64_t bits = next();
    const std::uint64_t pairs = (bits & kEven) + ((bits >> 8) & kEven);
    const std::uint64_t sum = (pairs * 0x0001000100010001ULL) >> 48;
    // Discrete uniforms 0 ... 255: mean 127.5 and variance (256^2 - 1) / 12 each.
    constexpr double kScale = 1.0 / 209.02153;  // sqrt(8 * 65535 / 12)
    return (static_cast<double>(sum) - 1020.0) * kScale;
  }

 private:
  std::uint64_t state_;
};

}  // namespace glint::synth
