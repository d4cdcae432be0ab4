// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/nearest_descriptors.hpp"

#include <algorithm>
#include <cstring>

#include "slam/nearest_kernel.hpp"

namespace glint::slam {

namespace {

static_assert(sizeof(Descriptor) == kernel::kDescriptorBytes);

// The baseline instruction set counts bits by twiddling them: seven times slower.
#if defined(__x86_64__)
#define GLINT_POPCNT __attribute__((target("popcnt")))
bool have_popcnt() { return __builtin_cpu_supports("popcnt") != 0; }
#else
#define GLINT_POPCNT
bool have_popcnt() { return true; }
#endif

using Nearest = NearestDescriptors::Nearest;

[[gnu::always_inline]] inline void find_one_by_one(std::span<const Descriptor> reference,
                                                   std::span<const Descriptor> current,
                                                   Nearest& of_reference, Nearest& of_current) {
  for (std::size_t c = 0; c < current.size(); ++c) {
    for (std::size_t r = 0; r < reference.size(); ++r) {
      int bits = 0;
      for (std::size_t i = 0; i < current[c].size(); ++i) {
        bits += __builtin_popcountll(current[c][i] ^ reference[r][i]);
      }
      if (bits < of_current.distance[c]) {
        of_current.distance[c] = static_cast<std::uint8_t>(bits);
        of_current.partner[c] = static_cast<std::int32_t>(r);
      }
      if (bits < of_reference.distance[r]) {
        of_reference.distance[r] = static_cast<std::uint8_t>(bits);
        of_reference.partner[r] = static_cast<std::int32_t>(c);
      }
    }
  }
}

GLINT_POPCNT void find_by_popcnt(std::span<const Descriptor> reference,
                                 std::span<const Descriptor> current, Nearest& of_reference,
                                 Nearest& of_current) {
  find_one_by_one(reference, current, of_reference, of_current);
}

void find_by_any_means(std::span<const Descriptor> reference, std::span<const Descriptor> current,
                       Nearest& of_reference, Nearest& of_current) {
  find_one_by_one(reference, current, of_reference, of_current);
}

}  // namespace

std::vector<NearestPath> nearest_paths() {
  std::vector<NearestPath> paths{NearestPath::kPortable};
#if defined(GLINT_NEAREST_X86)
  if (__builtin_cpu_supports("avx2") != 0) paths.push_back(NearestPath::kAvx2);
  if (__builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512bitalg") != 0) {
    paths.push_back(NearestPath::kAvx512);
  }
#endif
  return paths;
}

void NearestDescriptors::find(std::span<const Descriptor> reference,
                              std::span<const Descriptor> current) {
  of_reference_.partner.assign(reference.size(), -1);
  of_reference_.distance.assign(reference.size(), kernel::kFarthest);
  of_current_.partner.assign(current.size(), -1);
  of_current_.distance.assign(current.size(), kernel::kFarthest);
  if (reference.empty() || current.empty()) return;
  if (path_ == NearestPath::kPortable) {
    static auto* const find_all = have_popcnt() ? find_by_popcnt : find_by_any_means;
    find_all(reference, current, of_reference_, of_current_);
    return;
  }
#if defined(GLINT_NEAREST_X86)
  const bool wide = path_ == NearestPath::kAvx512;
  slice(reference, wide ? 64 : 32);
  const kernel::NearestTask task{
      slices_.front().bytes,
      reference.size(),
      reinterpret_cast<const std::uint8_t*>(current.data()),
      current.size(),
      reference_distance_.front().bytes,
      of_reference_.partner.data(),
      of_current_.distance.data(),
      of_current_.partner.data(),
  };
  (wide ? kernel::nearest_avx512 : kernel::nearest_avx2)(task);
  std::memcpy(of_reference_.distance.data(), task.reference_distance, reference.size());
#endif
}

// See NearestTask. What a last block lacks stays as it was and is not looked at.
void NearestDescriptors::slice(std::span<const Descriptor> reference, std::size_t lanes) {
  const std::size_t blocks = (reference.size() + lanes - 1) / lanes;
  constexpr std::size_t kLine = sizeof(Line);
  slices_.resize((blocks * lanes * kernel::kDescriptorBytes + kLine - 1) / kLine);
  reference_distance_.resize((blocks * lanes + kLine - 1) / kLine);
  std::memset(reference_distance_.front().bytes, kernel::kFarthest,
              reference_distance_.size() * kLine);
  std::uint8_t* const slices = slices_.front().bytes;
  for (std::size_t r = 0; r < reference.size(); ++r) {
    std::uint8_t bytes[kernel::kDescriptorBytes];
    std::memcpy(bytes, reference[r].data(), sizeof(bytes));
    std::uint8_t* const lane = slices + r / lanes * lanes * kernel::kDescriptorBytes + r % lanes;
    for (std::size_t j = 0; j < kernel::kDescriptorBytes; ++j) lane[j * lanes] = bytes[j];
  }
}

}  // namespace glint::slam
