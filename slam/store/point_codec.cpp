// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/point_codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "slam/store/compression.hpp"

namespace glint::slam {
namespace {

constexpr std::byte kPointFormat{1};
constexpr std::size_t kPointHeaderBytes = 1 + sizeof(std::uint32_t);
// More than any sensor's scan has.
constexpr std::uint32_t kMostPoints = 16'000'000;
constexpr std::size_t kMostBytesAPoint = 3 * 5 + 1;
constexpr float kFarthest_m = 1e6F;

constexpr std::array kAxes = {&MapPoint::x_m, &MapPoint::y_m, &MapPoint::z_m};

bool can_be_kept(const MapPoint& point) {
  return std::ranges::all_of(kAxes,
                             [&](auto axis) { return std::abs(point.*axis) <= kFarthest_m; });
}

std::int32_t quanta(float value_m) {
  return static_cast<std::int32_t>(std::lround(static_cast<double>(value_m) / kPointQuantum_m));
}

// Small numbers of either sign become small numbers.
std::uint32_t zigzag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1U) ^ static_cast<std::uint32_t>(value >> 31);
}
std::int32_t unzigzag(std::uint32_t value) {
  return static_cast<std::int32_t>((value >> 1U) ^ (0U - (value & 1U)));
}

void put_varint(std::vector<std::byte>& out, std::uint32_t value) {
  for (; value >= 0x80U; value >>= 7U) out.push_back(static_cast<std::byte>(value | 0x80U));
  out.push_back(static_cast<std::byte>(value));
}

// Takes a number off the front; false when there is none.
bool take_varint(std::span<const std::byte>& in, std::uint32_t& value) {
  value = 0;
  for (unsigned shift = 0; shift < 35 && !in.empty(); shift += 7) {
    const auto byte = std::to_integer<std::uint32_t>(in.front());
    in = in.subspan(1);
    value |= (byte & 0x7FU) << shift;
    if (byte < 0x80U) return true;
  }
  return false;
}

bool take_axis(std::span<const std::byte>& in, std::vector<MapPoint>& points,
               float MapPoint::*axis) {
  // Unsigned, for damaged bytes may add up to anything.
  std::uint32_t sum = 0;
  for (MapPoint& point : points) {
    std::uint32_t difference = 0;
    if (!take_varint(in, difference)) return false;
    sum += static_cast<std::uint32_t>(unzigzag(difference));
    point.*axis = static_cast<float>(static_cast<std::int32_t>(sum) * kPointQuantum_m);
  }
  return true;
}

}  // namespace

std::vector<std::byte> encode_points(std::span<const MapPoint> points) {
  std::vector<MapPoint> kept;
  kept.reserve(points.size());
  std::ranges::copy_if(points, std::back_inserter(kept), can_be_kept);
  const auto count = static_cast<std::uint32_t>(kept.size());
  std::vector<std::byte> out(kPointHeaderBytes, kPointFormat);
  out.reserve(kPointHeaderBytes + kept.size() * kMostBytesAPoint / 2);
  std::memcpy(&out[1], &count, sizeof count);
  for (const auto axis : kAxes) {
    std::int32_t last = 0;
    for (const MapPoint& point : kept) {
      const std::int32_t value = quanta(point.*axis);
      put_varint(out, zigzag(value - last));
      last = value;
    }
  }
  for (const MapPoint& point : kept) {
    const float intensity = std::clamp(std::round(point.intensity), 0.0F, 255.0F);
    out.push_back(static_cast<std::byte>(intensity));
  }
  return compress(out);
}

std::optional<std::vector<MapPoint>> decode_points(std::span<const std::byte> bytes) {
  const auto content = decompress(bytes, kPointHeaderBytes + kMostPoints * kMostBytesAPoint);
  if (!content || content->size() < kPointHeaderBytes || content->front() != kPointFormat)
    return std::nullopt;
  std::uint32_t count = 0;
  std::memcpy(&count, content->data() + 1, sizeof count);
  std::span<const std::byte> rest(*content);
  rest = rest.subspan(kPointHeaderBytes);
  // A point takes four bytes at least, so that no count asks for more memory than there is input.
  if (count > rest.size() / 4) return std::nullopt;
  std::vector<MapPoint> points(count);
  for (const auto axis : kAxes) {
    if (!take_axis(rest, points, axis)) return std::nullopt;
  }
  if (rest.size() != count) return std::nullopt;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].intensity = std::to_integer<std::uint8_t>(rest[i]);
  }
  return points;
}

}  // namespace glint::slam
