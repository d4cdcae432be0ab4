// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace glint::slam {

/// What odometry leaves out where the machine is too slow for it; each level leaves out what those
/// before it do. Deskewing and the solve are never left out. Nor are the patches that are followed:
/// there are some only where surfaces leave an axis open, and then nothing else may tell of it.
enum class LoadLevel {
  kFull,
  kFewerPatches,          ///< New ones in every second scan only, while enough are followed.
  kFewerKeypoints,        ///< Half as many.
  kFewerPoints,           ///< Half as many points on surfaces.
  kKeypointsEverySecond,  ///< Every second scan goes without keypoints.
};
constexpr std::size_t kLoadLevels = 5;
/// As in the status of the daemon: what each level leaves out.
constexpr std::array<std::string_view, kLoadLevels> kLoadLevelNames = {
    "none", "patches", "keypoints", "surface_points", "keypoints_every_second"};
/// The level of that name; kFull for any other.
LoadLevel load_level_of(std::string_view name);

}  // namespace glint::slam
