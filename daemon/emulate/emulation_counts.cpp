// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/emulate/emulation_counts.hpp"

namespace glint::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const PacketCounts& counts) {
  return {{"sent", counts.sent},           {"lost", counts.lost},
          {"delayed", counts.delayed},     {"duplicated", counts.duplicated},
          {"delivered", counts.delivered}, {"failed", counts.failed}};
}

}  // namespace

Json to_json(const EmulationCounts& counts) {
  constexpr double kMsPerNs = 1e-6;
  return {{"lidar", to_json(counts.lidar)},
          {"imu", to_json(counts.imu)},
          {"scans", counts.scans},
          {"cut_packets", counts.cut_packets},
          {"not_sent", counts.not_sent},
          {"starts", counts.starts},
          {"clock_jumps", counts.clock_jumps},
          {"foreign",
           {{"address", counts.foreign_address},
            {"size", counts.foreign_size},
            {"serial", counts.foreign_serial}}},
          {"worst_lateness_ms", static_cast<double>(counts.worst_lateness_ns) * kMsPerNs}};
}

}  // namespace glint::daemon
