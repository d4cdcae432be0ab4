// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <span>

#include "slam/odometry_estimate.hpp"

namespace glint::cli {

/// Writes a line a scan, with a heading: what odometry made of it, how it was seen and how sure its
/// pose is (`cov_*`: as OdometryEstimate::covariance, the upper triangle row by row).
/// @throws InputError naming the file.
void write_scan_table(const std::filesystem::path& file,
                      std::span<const slam::OdometryEstimate> estimates);

}  // namespace glint::cli
