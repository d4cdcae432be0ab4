// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "driver/core/clock.hpp"

namespace glint::slam {

/// A finished copy.
struct SessionCopy {
  std::filesystem::path file;
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;  ///< CRC-64/XZ of its bytes, as driver/core/crc64.hpp.
  double seconds = 0.0;        ///< What it took, by the clock that was given.
};

/// Told from time to time which share is done, 0 to 1; false gives the copy up.
using CopyProgress = std::function<bool(double share)>;

/// Copies a session, also one that is being written, as it is at one moment. The copy gets its name
/// only once it is whole and on the disk, in place of what had it. Null when it was given up;
/// nothing is left of it then. To be called from a thread that may wait for the disk.
/// @throws InputError naming the file, when `source` is none or `target` cannot be written.
std::optional<SessionCopy> copy_session(const std::filesystem::path& source,
                                        const std::filesystem::path& target, Clock clock = {},
                                        const CopyProgress& progress = {});

}  // namespace glint::slam
