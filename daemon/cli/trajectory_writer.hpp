// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "driver/core/pose.hpp"
#include "driver/core/time.hpp"

namespace glint::cli {

/// A pose and the time it belongs to.
struct StampedPose {
  SensorTime stamp;
  Pose T_frame_sensor;
};

/// Seconds with nine decimals, exact: "1317000000.099999905".
std::string seconds_text(SensorTime stamp);

/// How many poses have a time that is not after all times before it: a file of rising times lacks
/// them. The sensor's clock went back there.
std::size_t count_not_rising(std::span<const StampedPose> poses);

/// Writes `t x y z qx qy qz qw` a line (TUM). Coordinates are written so that they read back to the
/// same bits. Poses whose time does not rise are left out. @throws InputError naming the file.
void write_tum(const std::filesystem::path& file, std::span<const StampedPose> poses);

/// Writes the 3x4 matrices (KITTI) of the same poses, and their times in seconds to `times_file`.
void write_kitti(const std::filesystem::path& file, const std::filesystem::path& times_file,
                 std::span<const StampedPose> poses);

}  // namespace glint::cli
