// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "driver/core/sensor_info.hpp"

namespace glint {

/// The profile that sensors spell so; null if it is not known here.
std::optional<LidarProfile> lidar_profile_named(std::string_view name);
std::optional<ImuProfile> imu_profile_named(std::string_view name);

/// The known lidar profile whose name comes nearest to one that is not.
LidarProfile nearest_lidar_profile(std::string_view unknown);

/// All lidar profiles' names, with commas between.
std::string lidar_profile_list();

/// Which profiles have lidar packets of so many bytes, e.g. "LEGACY with 64 beams": with the likely
/// number of beams if any has, else with each usual one; empty if none has.
std::string profiles_of_size(std::size_t packet_bytes, int likely_beams);

}  // namespace glint
