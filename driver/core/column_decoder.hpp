// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_format.hpp"

namespace glint {

/// Writes the pixels of neighbouring columns into a scan of the same format.
/// `pixels` points at the first pixel of the first column; `count` columns go to first_column,
/// first_column + 1, ... , all of which must lie inside the scan.
using DecodeColumns = void (*)(const PacketFormat& format, const std::byte* pixels, int count,
                               int first_column, LidarScan& scan);

enum class DecoderPath {
  kFastest,   ///< The best that this processor can.
  kPortable,  ///< What every processor can. For tests; the results are the same.
};

/// The decoder compiled for a profile's layout.
DecodeColumns column_decoder(LidarProfile profile, DecoderPath path = DecoderPath::kFastest);

}  // namespace glint
