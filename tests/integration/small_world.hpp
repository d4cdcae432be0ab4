// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "driver/core/sensor_info.hpp"
#include "pcap/test_capture.hpp"

namespace glint::test {

/// A capture of three whole scans of a small sensor, and IMU packets every 10 ms, at 10 Hz.
class SmallWorld {
 public:
  explicit SmallWorld(LidarProfile profile);

  static constexpr int kPacketsPerScan = 32;
  const SensorInfo info;
  const TempDir dir;
  const std::filesystem::path capture = dir / "capture.pcap";
  const std::filesystem::path report = dir / "report.json";
  [[nodiscard]] nlohmann::json read_report() const;
};

/// A port of the loopback interface, and the one after it, that nobody holds now.
std::uint16_t free_udp_ports();

}  // namespace glint::test
