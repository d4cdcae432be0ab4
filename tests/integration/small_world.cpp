// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "tests/integration/small_world.hpp"

#include <fstream>

#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/test_sensor.hpp"
#include "driver/udp_source.hpp"
#include "pcap/capture_writer.hpp"

namespace glint::test {

SmallWorld::SmallWorld(LidarProfile profile) : info(make_sensor(profile, 16, 512)) {
  std::ofstream(dir / "capture.json") << to_metadata_json(info);
  std::mt19937 random(5);
  CaptureWriter writer(capture);
  Endpoint imu_port = receiver();
  imu_port.port = 7503;
  constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
  for (std::int64_t k = 0; k < 3; ++k) {
    const LidarScan scan = random_scan(info, static_cast<std::uint16_t>(100 + k), random);
    const auto packets = encode(info, scan);
    for (std::size_t i = 0; i < packets.size(); ++i) {
      const std::int64_t time_ns = kStart_ns + k * info.scan_period_ns() +
                                   static_cast<std::int64_t>(i) * info.scan_period_ns() /
                                       static_cast<std::int64_t>(packets.size());
      writer.write({time_ns}, sender(), receiver(), packets[i]);
      if (i % 4 != 0) continue;
      const SensorTime time = scan.column_time[16 * i];
      const ImuSample still{time, time, {0.0, 0.0, 9.81}, {0.0, 0.0, 0.0}};
      Bytes imu;
      ImuPacketWriter(info).write({&still, 1}, 0, 0, imu);
      writer.write({time_ns}, sender(), imu_port, imu);
    }
  }
  writer.finish();
}

nlohmann::json SmallWorld::read_report() const {
  std::ifstream in(report);
  return nlohmann::json::parse(in);
}

std::uint16_t free_udp_ports() {
  UdpSourceOptions options;
  options.bind_address = "127.0.0.1";
  options.lidar_port = 0;
  options.imu_port = 0;
  return UdpSource(options).lidar_port();
}

}  // namespace glint::test
