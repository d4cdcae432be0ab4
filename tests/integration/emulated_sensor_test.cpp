// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// `glint emulate --http`: a sensor that is asked and set over the network, sends accordingly, and
// knows exactly what it did.
#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <csignal>
#include <fstream>
#include <set>

#include "driver/core/scan_assembler.hpp"
#include "driver/session/network_client.hpp"
#include "driver/udp_source.hpp"
#include "tests/integration/glint_command.hpp"
#include "tests/integration/small_world.hpp"

namespace glint {
namespace {

using Json = nlohmann::json;

/// What a receiver saw of one sensor.
struct Seen {
  std::uint64_t lidar = 0;
  std::uint64_t imu = 0;
  std::uint64_t other = 0;
  std::vector<std::uint32_t> frame_ids;
  std::set<std::uint32_t> init_ids;
  std::vector<std::int64_t> times_ns;  ///< Of valid columns.
};

class EmulatedSensorTest : public ::testing::TestWithParam<LidarProfile> {
 protected:
  EmulatedSensorTest() : world_(GetParam()), port_(test::free_udp_ports()) {
    UdpSourceOptions options;
    options.bind_address = "127.0.0.1";
    options.lidar_port = port_;
    options.imu_port = port_;  // Told apart by size.
    source_.emplace(options);
  }

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {
        "emulate",    world_.capture,        "--to",     "127.0.0.1:" + std::to_string(port_),
        "--imu-port", std::to_string(port_), "--report", world_.report};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Receives until nothing has come for a second.
  Seen receive(ScanAssembler& assembler) {
    Seen seen;
    receive(assembler, seen);
    return seen;
  }
  void receive(ScanAssembler& assembler, Seen& seen) {
    RawPacket packet;
    auto last = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - last < std::chrono::seconds(1)) {
      if (source_->read(packet) != SourceStatus::kPacket) continue;
      last = std::chrono::steady_clock::now();
      take(packet.bytes, assembler, seen);
    }
    assembler.flush();
    drain(assembler, seen);
  }

  /// Receives until the sensor's own stream has begun, of which the IMU is a sign.
  void receive_first(ScanAssembler& assembler, Seen& seen) {
    RawPacket packet;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (seen.imu == 0 && std::chrono::steady_clock::now() < deadline) {
      if (source_->read(packet) == SourceStatus::kPacket) take(packet.bytes, assembler, seen);
    }
  }

  void take(const std::vector<std::byte>& bytes, ScanAssembler& assembler, Seen& seen) {
    if (bytes.size() == format_.imu_packet_bytes) {
      ++seen.imu;
      return;
    }
    const auto view = PacketView::parse(format_, bytes);
    ++(view ? seen.lidar : seen.other);
    if (view) seen.init_ids.insert(view->init_id());
    static_cast<void>(assembler.push(bytes));
    drain(assembler, seen);
  }

  static void drain(ScanAssembler& assembler, Seen& seen) {
    while (const LidarScan* scan = assembler.next()) {
      seen.frame_ids.push_back(scan->frame_id);
      for (std::size_t m = 0; m < scan->column_time.size(); ++m) {
        if ((scan->column_status[m] & 1U) != 0) seen.times_ns.push_back(scan->column_time[m].ns);
      }
    }
  }

  /// Asks the sensor one thing, or sets something.
  Json ask(int http_port, SensorResource resource) {
    Json answer;
    with_client(
        http_port,
        [&](NetworkSensorClient& client, const SensorClient::Handler& handler) {
          client.read(resource, handler);
        },
        answer);
    return answer;
  }
  void set(int http_port, const Json& changes) {
    Json answer;
    with_client(
        http_port,
        [&](NetworkSensorClient& client, const SensorClient::Handler& handler) {
          client.write_config(changes, false, handler);
        },
        answer);
  }
  template <class Call>
  static void with_client(int http_port, Call call, Json& answer) {
    boost::asio::io_context io;
    NetworkSensorClient client(io, {"127.0.0.1", static_cast<std::uint16_t>(http_port), 1},
                               ClientTimeouts{});
    client.read(SensorResource::kSensorInfo, [](const SensorReply&) {});
    io.run();
    io.restart();
    call(client, [&](const SensorReply& reply) {
      EXPECT_EQ(reply.failure, "");
      answer = reply.value;
    });
    io.run();
  }

  const test::SmallWorld world_;
  const std::uint16_t port_;
  const PacketFormat format_{world_.info};
  std::optional<UdpSource> source_;
};

INSTANTIATE_TEST_SUITE_P(Profiles, EmulatedSensorTest,
                         ::testing::Values(LidarProfile::kLegacy,
                                           LidarProfile::kRng19Rfl8Sig16Nir16,
                                           LidarProfile::kFusaRng15Rfl8Nir8Dual),
                         [](const auto& param) { return std::string(to_string(param.param)); });

TEST_P(EmulatedSensorTest, ALoopedCaptureIsOneStreamWithoutAGap) {
  test::GlintProcess sensor(command({"--loop", "6", "--rate", "4"}));
  ScanAssembler assembler(world_.info);
  const Seen seen = receive(assembler);
  EXPECT_EQ(sensor.finish().exit_code, 0);
  ASSERT_EQ(seen.frame_ids.size(), 18U);
  for (std::uint32_t i = 0; i < 18; ++i) EXPECT_EQ(seen.frame_ids[i], i);
  ASSERT_EQ(seen.times_ns.size(), 18U * 512U);
  for (std::size_t i = 1; i < seen.times_ns.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(seen.times_ns[i] - seen.times_ns[i - 1]), 1e8 / 512, 1.0);
  }
  EXPECT_EQ(assembler.counters().missing_packets, 0U);
  EXPECT_EQ(seen.imu, 18U * 8U);
  const Json report = world_.read_report();
  EXPECT_EQ(report["lidar"]["delivered"], seen.lidar);
  EXPECT_EQ(report["imu"]["delivered"], seen.imu);
  EXPECT_EQ(report["scans"], 18);
}

TEST_P(EmulatedSensorTest, WhatABadLineDoesIsCountedExactly) {
  test::GlintProcess sensor(command({"--loop", "30", "--rate", "10", "--loss", "0.05",
                                     "--reordering", "0.05", "--duplicates", "0.04"}));
  ScanAssembler assembler(world_.info);
  const Seen seen = receive(assembler);
  EXPECT_EQ(sensor.finish().exit_code, 0);
  const Json report = world_.read_report();
  const Json& lidar = report["lidar"];
  EXPECT_EQ(lidar["sent"], 90 * test::SmallWorld::kPacketsPerScan);
  EXPECT_GT(lidar["lost"], 60);
  EXPECT_GT(lidar["delayed"], 60);
  EXPECT_GT(lidar["duplicated"], 50);
  EXPECT_EQ(lidar["delivered"], seen.lidar);
  EXPECT_EQ(report["imu"]["delivered"], seen.imu);
  const AssemblerCounters& counters = assembler.counters();
  EXPECT_EQ(counters.late_packets + counters.duplicate_packets, lidar["duplicated"]);
  EXPECT_EQ(counters.missing_packets, lidar["lost"]);
  EXPECT_EQ(counters.packets,
            lidar["sent"].get<std::uint64_t>() - lidar["lost"].get<std::uint64_t>());
}

TEST_P(EmulatedSensorTest, IsAskedSetAndRestartedOverTheNetwork) {
  std::ofstream(world_.dir / "scenario.toml") << R"(
[[event]]
at_s = 0.2
action = "foreign_packets"
count = 9
[[event]]
at_s = 2.0
action = "restart"
[[event]]
at_s = 3.0
action = "clock_jump"
seconds = 3.0
)";
  test::GlintProcess sensor(
      command({"--http", "0", "--firmware", "v3.1.0", "--boot", "0.3", "--reinitialise", "0.2",
               "--seconds", "4", "--scenario", world_.dir / "scenario.toml"}));
  const int http_port = sensor.number_after("HTTP on port ");
  const Json metadata = ask(http_port, SensorResource::kMetadata);
  EXPECT_EQ(metadata["config_params"]["udp_port_lidar"], port_);
  EXPECT_EQ(parse_sensor_info(metadata.dump(), "it").serial_number, world_.info.serial_number);
  // What is set before the first start would be part of it.
  ScanAssembler assembler(world_.info);
  Seen seen;
  receive_first(assembler, seen);
  ASSERT_GT(seen.imu, 0U);
  set(http_port, {{"signal_multiplier", 2}});
  EXPECT_EQ(ask(http_port, SensorResource::kActiveConfig)["signal_multiplier"], 2);

  receive(assembler, seen);
  EXPECT_EQ(sensor.finish().exit_code, 0);
  const Json report = world_.read_report();
  EXPECT_EQ(report["sensor"]["config_writes"], 1);
  EXPECT_EQ(report["sensor"]["restarts"], 1);
  EXPECT_EQ(report["starts"], 3) << "the first, after the setting, after the restart";
  EXPECT_EQ(report["clock_jumps"], 1);
  const auto& foreign = report["foreign"];
  EXPECT_EQ(
      foreign["address"].get<int>() + foreign["size"].get<int>() + foreign["serial"].get<int>(), 9);
  EXPECT_EQ(foreign["address"], 3) << "the receiver takes any address";
  EXPECT_EQ(seen.other, foreign["size"]);
  EXPECT_EQ(seen.lidar, report["lidar"]["delivered"].get<std::uint64_t>() +
                            foreign["address"].get<std::uint64_t>() +
                            foreign["serial"].get<std::uint64_t>());
  // Off for 0.2 s and 0.3 s at 320 packets a second.
  EXPECT_NEAR(report["not_sent"].get<double>(), 0.5 * 320, 64.0);
  // Legacy packets have nothing but their frame ids to tell a restart by, which takes a scan.
  if (GetParam() == LidarProfile::kLegacy) return;
  EXPECT_EQ(seen.init_ids.size(), 3U);
  EXPECT_EQ(std::count(seen.frame_ids.begin(), seen.frame_ids.end(), 0U), 3);
}

TEST_P(EmulatedSensorTest, EndsWithASummaryAtASignal) {
  test::GlintProcess sensor(command({"--http", "0"}));
  sensor.wait_for("HTTP on port ");
  RawPacket packet;
  while (source_->read(packet) != SourceStatus::kPacket) {
  }
  sensor.send_signal(SIGTERM);
  const test::CommandResult result = sensor.finish();
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, ::testing::HasSubstr("lidar packets"));
  EXPECT_GT(world_.read_report()["lidar"]["sent"], 0);
}

}  // namespace
}  // namespace glint
