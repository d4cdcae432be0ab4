// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/feature_codec.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "slam/loops/place.hpp"
#include "slam/store/compression.hpp"

namespace glint::slam {
namespace {

static_assert(std::endian::native == std::endian::little, "values are kept as they lie in memory");

constexpr std::byte kFeatureFormat{1};
constexpr std::size_t kKeypointBytes = sizeof(Descriptor) + 7 * sizeof(float) + 1;
constexpr std::size_t kFeatureHeaderBytes = 1 + sizeof(std::uint32_t);
constexpr std::size_t kMostKeypoints = 100'000;

using Keypoint = Features::Keypoint;
constexpr std::array kFloats = {&Keypoint::u_px, &Keypoint::v_px, &Keypoint::angle_rad,
                                &Keypoint::response};

template <class Value>
void put_value(std::vector<std::byte>& out, const Value& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

template <class Value>
Value take_value(std::span<const std::byte>& in) {
  Value value;
  std::memcpy(&value, in.data(), sizeof value);
  in = in.subspan(sizeof value);
  return value;
}

// Ties go to the first ones, as make_place() has it.
std::vector<std::size_t> strongest_in_order(const Features& features, std::size_t most) {
  std::vector<std::size_t> numbers(features.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  if (numbers.size() <= most) return numbers;
  std::ranges::stable_sort(numbers, [&](std::size_t a, std::size_t b) {
    return features.keypoints[a].response > features.keypoints[b].response;
  });
  numbers.resize(most);
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace

std::vector<std::byte> encode_features(const Features& features) {
  const auto numbers = strongest_in_order(features, PlaceOptions{}.most_keypoints);
  std::vector<std::byte> out;
  out.reserve(kFeatureHeaderBytes + numbers.size() * kKeypointBytes);
  put_value(out, kFeatureFormat);
  put_value(out, static_cast<std::uint32_t>(numbers.size()));
  for (const std::size_t i : numbers) put_value(out, features.descriptors[i]);
  for (const std::size_t i : numbers) {
    const Eigen::Vector3f point_m = features.points_m[i].cast<float>();
    for (const float value_m : point_m) put_value(out, value_m);
  }
  for (const auto member : kFloats) {
    for (const std::size_t i : numbers) put_value(out, features.keypoints[i].*member);
  }
  for (const std::size_t i : numbers) {
    put_value(out, static_cast<std::uint8_t>(features.keypoints[i].octave));
  }
  return compress(out);
}

std::optional<Features> decode_features(std::span<const std::byte> bytes) {
  const auto content = decompress(bytes, kFeatureHeaderBytes + kMostKeypoints * kKeypointBytes);
  if (!content || content->size() < kFeatureHeaderBytes || content->front() != kFeatureFormat)
    return std::nullopt;
  std::span<const std::byte> rest(*content);
  rest = rest.subspan(1);
  const auto count = take_value<std::uint32_t>(rest);
  if (rest.size() != count * kKeypointBytes) return std::nullopt;
  Features features;
  features.keypoints.resize(count);
  features.descriptors.resize(count);
  features.points_m.resize(count);
  for (Descriptor& descriptor : features.descriptors) descriptor = take_value<Descriptor>(rest);
  for (Eigen::Vector3d& point_m : features.points_m) {
    for (double& value_m : point_m) value_m = take_value<float>(rest);
  }
  for (const auto member : kFloats) {
    for (Keypoint& keypoint : features.keypoints) keypoint.*member = take_value<float>(rest);
  }
  for (Keypoint& keypoint : features.keypoints) keypoint.octave = take_value<std::uint8_t>(rest);
  return features;
}

}  // namespace glint::slam
