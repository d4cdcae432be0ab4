// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "driver/core/packet_view.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// What the lidar packets of one stream say of the sensor that sent them. Value type; add() does
/// not allocate.
struct PacketEvidence {
  /// A packet whose columns are not in order is damaged and proves nothing.
  void add(const PacketView& packet);

  std::uint64_t serial_number = 0;          ///< Of the first packet that tells it; else 0.
  std::array<std::uint32_t, 4> init_ids{};  ///< The first different ones, then 0.
  std::uint64_t frames = 0;                 ///< How often the frame id was another than before.
  std::uint32_t frame_id = 0;               ///< Of the newest packet.
  int last_column = -1;                     ///< Largest measurement id; -1 without packets.
};

/// What in a stream's packets contradicts the metadata they are to be read by: another sensor,
/// another start of it, another number of columns. One sentence that names both values and the way
/// out and begins with `packets`, such as "The lidar packets in drive.pcap"; empty if nothing does.
std::string metadata_contradiction(const SensorInfo& info, const PacketEvidence& evidence,
                                   std::string_view packets);

}  // namespace glint
