// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/profile_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "driver/core/edit_distance.hpp"
#include "driver/core/packet_format.hpp"

namespace glint {
namespace {

struct ProfileName {
  LidarProfile profile;
  std::string_view name;
};
constexpr std::array<ProfileName, 13> kProfileNames{{
    {LidarProfile::kLegacy, "LEGACY"},
    {LidarProfile::kRng19Rfl8Sig16Nir16, "RNG19_RFL8_SIG16_NIR16"},
    {LidarProfile::kRng19Rfl8Sig16Nir16Dual, "RNG19_RFL8_SIG16_NIR16_DUAL"},
    {LidarProfile::kRng15Rfl8Nir8, "RNG15_RFL8_NIR8"},
    {LidarProfile::kRng15Rfl8Win8, "RNG15_RFL8_WIN8"},
    {LidarProfile::kRng15Rfl8Nir8Dual, "RNG15_RFL8_NIR8_DUAL"},
    {LidarProfile::kFusaRng15Rfl8Nir8Dual, "FUSA_RNG15_RFL8_NIR8_DUAL"},
    {LidarProfile::kFiveWordPixel, "FIVE_WORD_PIXEL"},
    {LidarProfile::kRng15Rfl8Nir8Zone16, "RNG15_RFL8_NIR8_ZONE16"},
    {LidarProfile::kRng19Rfl8Sig16Nir16Zone16, "RNG19_RFL8_SIG16_NIR16_ZONE16"},
    {LidarProfile::kRng19Rfl8Sig16Zone16Dual, "RNG19_RFL8_SIG16_ZONE16_DUAL"},
    {LidarProfile::kRng19Rfl8Sig16Nir16Rgb16, "RNG19_RFL8_SIG16_NIR16_RGB16"},
    {LidarProfile::kRng19Rfl8Sig16Nir16Rgb16Dual, "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL"},
}};

constexpr std::array kImuProfileNames{
    std::pair{ImuProfile::kLegacy, std::string_view("LEGACY")},
    std::pair{ImuProfile::kAccel32Gyro32Nmea, std::string_view("ACCEL32_GYRO32_NMEA")},
};

constexpr std::array kUsualBeams{16, 32, 64, 128, 256};
constexpr int kUsualColumnsPerPacket = 16;

int usual_packet_bytes(const ProfileLayout& layout, int beams) {
  const int column_bytes =
      layout.column_header_bytes + beams * layout.pixel_bytes + layout.column_footer_bytes;
  return layout.packet_header_bytes + kUsualColumnsPerPacket * column_bytes +
         layout.packet_footer_bytes;
}

/// "RNG15_RFL8_NIR8, RNG15_RFL8_WIN8 with 128 beams"; empty if there is none.
std::string profiles_with(int beams, std::size_t packet_bytes) {
  std::string list;
  for (const ProfileName& known : kProfileNames) {
    const int bytes = usual_packet_bytes(profile_layout(known.profile), beams);
    if (static_cast<std::size_t>(bytes) != packet_bytes) continue;
    list += fmt::format("{}{}", list.empty() ? "" : ", ", known.name);
  }
  return list.empty() ? list : fmt::format("{} with {} beams", list, beams);
}

}  // namespace

std::span<const LidarProfile> lidar_profiles() {
  static constexpr auto kAll = [] {
    std::array<LidarProfile, kProfileNames.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = kProfileNames[i].profile;
    return all;
  }();
  return kAll;
}

std::string_view to_string(LidarProfile profile) {
  return kProfileNames[static_cast<std::size_t>(profile)].name;
}

std::string_view to_string(ImuProfile profile) {
  return kImuProfileNames[static_cast<std::size_t>(profile)].second;
}

std::optional<LidarProfile> lidar_profile_named(std::string_view name) {
  const auto* found = std::ranges::find(kProfileNames, name, &ProfileName::name);
  return found == kProfileNames.end() ? std::nullopt : std::optional(found->profile);
}

std::optional<ImuProfile> imu_profile_named(std::string_view name) {
  const auto* found = std::ranges::find_if(kImuProfileNames,
                                           [&](const auto& known) { return known.second == name; });
  return found == kImuProfileNames.end() ? std::nullopt : std::optional(found->first);
}

LidarProfile nearest_lidar_profile(std::string_view unknown) {
  return std::ranges::min_element(
             kProfileNames, {},
             [&](const ProfileName& known) { return edit_distance(unknown, known.name); })
      ->profile;
}

std::string lidar_profile_list() {
  std::string list;
  for (const ProfileName& known : kProfileNames) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", known.name);
  }
  return list;
}

std::string profiles_of_size(std::size_t packet_bytes, int likely_beams) {
  if (std::string likely = profiles_with(likely_beams, packet_bytes); !likely.empty())
    return likely;
  std::string list;
  for (const int beams : kUsualBeams) {
    const std::string profiles = profiles_with(beams, packet_bytes);
    if (!profiles.empty()) list += fmt::format("{}{}", list.empty() ? "" : "; ", profiles);
  }
  return list;
}

}  // namespace glint
