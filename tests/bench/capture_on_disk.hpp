// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "driver/core/scan_assembler.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/pcap_source.hpp"
#include "tests/bench/packet_ring.hpp"

namespace glint::bench {

/// A capture of a ring's scans in the temporary folder, removed at the end.
class CaptureOnDisk {
 public:
  CaptureOnDisk(const SensorInfo& info, const PacketRing& ring, int mtu)
      : info_(info),
        file_(std::filesystem::temp_directory_path() /
              ("glint_bench_" + std::to_string(getpid()) + "_" + std::to_string(mtu) + ".pcap")) {
    const Endpoint sensor{IpAddress::v4(192, 0, 2, 1), 7502};
    const Endpoint host{IpAddress::v4(192, 0, 2, 2), static_cast<std::uint16_t>(info.lidar_port)};
    CaptureWriter writer(file_, {mtu});
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const SensorTime time =
          test::nominal_time(info, static_cast<std::int64_t>(i / ring.packets_per_scan()), 0);
      writer.write({time.ns}, sensor, host, ring.packet(i));
    }
    writer.finish();
  }
  ~CaptureOnDisk() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  CaptureOnDisk(const CaptureOnDisk&) = delete;
  CaptureOnDisk& operator=(const CaptureOnDisk&) = delete;

  /// Reads the capture to its end, the look for the sensor's flow included; the complete scans.
  [[nodiscard]] std::size_t replay() const {
    PcapSource source(file_, info_);
    ScanAssembler assembler(info_);
    RawPacket packet;
    std::size_t complete = 0;
    while (source.read(packet) == SourceStatus::kPacket) {
      static_cast<void>(assembler.push(packet.bytes));
      while (const LidarScan* scan = assembler.next()) {
        complete += scan->columns_received == scan->columns_expected ? 1U : 0U;
      }
    }
    return complete;
  }

 private:
  const SensorInfo info_;
  const std::filesystem::path file_;
};

}  // namespace glint::bench
