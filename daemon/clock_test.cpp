// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What poses tell of time, and of a mounting that is not level, over real TCP.
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/clock_settings.hpp"
#include "daemon/test_daemon.hpp"
#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/scan_assembler.hpp"
#include "slam/frontend.hpp"

namespace glint::daemon {
namespace {

using test::Bytes;
using test::FakeSource;
using test::has_poses;
using test::room_packets;
using test::TestDaemon;
using namespace std::chrono_literals;

constexpr std::int64_t kPacketsPerScan = 512 / 16;
constexpr std::int64_t kPacketGap_ns = 100'000'000 / kPacketsPerScan;

std::int64_t integer(const Json& json, const char* key) { return json[key].get<std::int64_t>(); }

/// When the last packet of the `count`-th scan is received.
std::int64_t received_ns(int count) {
  return FakeSource::kFakeStart_ns + kPacketGap_ns * (count * kPacketsPerScan - 1);
}

/// Packets of `count` scans; the sensor's clock steps before scan `step_scan`.
std::vector<Bytes> stepped_packets(const SensorInfo& info, int count, int step_scan,
                                   std::int64_t step_ns) {
  ScanAssembler assembler(info);
  std::vector<Bytes> packets;
  for (const Bytes& packet : room_packets(info, count)) {
    EXPECT_EQ(assembler.push(packet), PacketVerdict::kLidar);
    while (const LidarScan* assembled = assembler.next()) {
      LidarScan scan = *assembled;
      for (SensorTime& time : scan.column_time) {
        if (static_cast<int>(scan.frame_id) >= step_scan) time.ns += step_ns;
      }
      for (Bytes& encoded : test::encode(info, scan)) packets.push_back(std::move(encoded));
    }
  }
  return packets;
}

TEST(ClockTest, EveryPoseTellsItsClockAndItsTimeOnThisMachine) {
  constexpr int kScans = 6;
  TestDaemon daemon;
  daemon.feed(room_packets(daemon.info(), kScans));
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, kScans); }));
  Client client(daemon.address());
  const Json pose = client.call("get_pose");
  EXPECT_EQ(pose["clock"], "internal");
  EXPECT_NEAR(static_cast<double>(integer(pose, "t_host_ns") - received_ns(kScans)), 0.0, 2000.0);
  EXPECT_GT(integer(pose, "clock_sigma_ns"), 0);
  EXPECT_LT(integer(pose, "clock_sigma_ns"), 1'000'000);

  const Json past = client.call("get_pose", {{"at_ns", integer(pose, "t_ns") - 150'000'000}});
  EXPECT_EQ(past["clock"], "internal");
  EXPECT_NEAR(static_cast<double>(integer(past, "t_host_ns") - integer(pose, "t_host_ns")), -150e6,
              2000.0);
  EXPECT_GT(integer(past, "clock_sigma_ns"), 0);
  const Json ahead = client.call("get_pose", {{"predict_ms", 50}});
  EXPECT_EQ(integer(ahead, "t_host_ns"), integer(pose, "t_host_ns") + 50'000'000);

  const Json clock = client.call("get_status")["clock"];
  EXPECT_EQ(clock["source"], "internal");
  EXPECT_NEAR(static_cast<double>(integer(clock, "offset_ns") -
                                  (integer(pose, "t_host_ns") - integer(pose, "t_ns"))),
              0.0, 2000.0);
  EXPECT_EQ(clock["jumps"], 0);
}

/// Where the sensor is said to be along x after each scan of an undisturbed stream.
std::vector<double> undisturbed_m(const SensorInfo& info, int count) {
  ScanAssembler assembler(info);
  slam::Frontend frontend(info, {});
  std::vector<double> positions;
  for (const Bytes& packet : room_packets(info, count)) {
    EXPECT_EQ(assembler.push(packet), PacketVerdict::kLidar);
    while (const LidarScan* scan = assembler.next()) {
      positions.push_back(frontend.process(*scan).T_odom_sensor.translation_m.x());
    }
  }
  return positions;
}

class SensorClockJump : public testing::TestWithParam<std::int64_t> {};

TEST_P(SensorClockJump, IsAnEventAndTrackingGoesOn) {
  constexpr int kScans = 16;
  constexpr int kStepScan = 8;
  TestDaemon daemon;
  Client client(daemon.address());
  client.call("subscribe", {{"topics", {"events", "pose"}}, {"frame", "odom"}});
  daemon.feed(stepped_packets(daemon.info(), kScans, kStepScan, GetParam()));
  std::vector<Json> poses;
  std::vector<Json> events;
  while (poses.size() < kScans || events.empty()) {
    const Json message = client.next_message(10s);
    (message["method"] == "event" ? events : poses).push_back(message["params"]);
  }
  const std::vector<double> expected_m = undisturbed_m(daemon.info(), kScans);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0]["kind"], "clock");
  EXPECT_NEAR(static_cast<double>(integer(events[0], "jump_ns")), static_cast<double>(-GetParam()),
              1e6);
  EXPECT_EQ(events[0]["jumps"], 1);
  for (std::size_t i = 0; i < kScans; ++i) {
    EXPECT_EQ(poses[i]["missed"], 0);
    // A busy machine may tell of a pose late, which is then DEGRADED for that.
    const bool told_in_time = poses[i]["stale"] == false;
    if (i > 0 && told_in_time) {
      EXPECT_EQ(poses[i]["state"], "TRACKING") << i;
    }
    EXPECT_NEAR(poses[i]["p_m"][0].get<double>(), expected_m[i], 0.005) << i;
    EXPECT_NEAR(
        static_cast<double>(integer(poses[i], "t_host_ns") - received_ns(static_cast<int>(i) + 1)),
        0.0, 1e5)
        << i;
  }
  client.call("unsubscribe");
  const auto between_ns = integer(poses.back(), "t_ns") - 50'000'000;
  EXPECT_NEAR(client.call("get_pose", {{"at_ns", between_ns}})["p_m"][0].get<double>(),
              (expected_m[kScans - 2] + expected_m[kScans - 1]) / 2, 0.01);
  EXPECT_EQ(client.call("get_status")["clock"]["jumps"], 1);
}

INSTANTIATE_TEST_SUITE_P(Steps, SensorClockJump,
                         testing::Values(3'000'000'000, -3'000'000'000, 3'600'000'000'000));

TEST(ClockTest, TheOffsetOfTaiIsTakenOffThePtpClockAndNoOther) {
  const auto packets = room_packets(test::room_sensor(), 2);
  const auto stamp_ns = [&](const char* clock) {
    Config config;
    config.sensor.clock = clock;
    config.sensor.tai_utc_offset_s = 37;
    TestDaemon daemon(config);
    daemon.feed(packets);
    EXPECT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 2); }));
    Client client(daemon.address());
    const Json pose = client.call("get_pose");
    EXPECT_EQ(pose["clock"], clock);
    EXPECT_NEAR(static_cast<double>(integer(pose, "t_host_ns") - received_ns(2)), 0.0, 2000.0);
    return integer(pose, "t_ns");
  };
  const std::int64_t utc_ns = stamp_ns("pps");
  EXPECT_EQ(stamp_ns("ptp"), utc_ns - 37'000'000'000);
}

TEST(ClockTest, PosesInTheTimeOfThisMachineCanBeAskedForByIt) {
  Config config;
  config.sensor.clock = "host";
  TestDaemon daemon(config);
  daemon.feed(room_packets(daemon.info(), 4));
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 4); }));
  Client client(daemon.address());
  const Json pose = client.call("get_pose");
  EXPECT_EQ(pose["clock"], "host");
  EXPECT_EQ(pose["t_ns"], pose["t_host_ns"]);
  EXPECT_NEAR(static_cast<double>(integer(pose, "t_ns") - received_ns(4)), 0.0, 2000.0);
  const Json past = client.call("get_pose", {{"at_ns", received_ns(3)}});
  EXPECT_NEAR(past["p_m"][0].get<double>(), 0.1, 0.03);
}

TEST(ClockTest, TheConfigurationGoesBeforeTheMetadata) {
  SensorInfo info = test::room_sensor();
  info.clock = ClockSource::kPps;
  EXPECT_EQ(with_clock_settings(info, {}).clock, ClockSource::kPps);
  Config::Sensor sensor;
  sensor.clock = "ptp";
  EXPECT_EQ(with_clock_settings(info, sensor).clock, ClockSource::kPtp);
}

TEST(MountTest, TheBaseOfASensorThatHangsUpsideDownIsUpright) {
  Config config;
  config.mount.T_base_sensor = {so3_exp({M_PI, 0, 0}), {0.2, 0.0, 0.9}};
  TestDaemon daemon(config);
  daemon.feed(room_packets(daemon.info(), 4));
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 4); }));
  Client client(daemon.address());
  const Json first = client.call("get_trajectory", {{"child", "base"}})["poses"][0];
  EXPECT_NEAR(std::abs(first["q_xyzw"][3].get<double>()), 1.0, 1e-9);
  EXPECT_NEAR(first["p_m"][2].get<double>(), -0.9, 1e-9);
  const Json last = client.call("get_pose", {{"child", "base"}});
  EXPECT_NEAR(last["p_m"][0].get<double>() - first["p_m"][0].get<double>(), 0.15, 0.06);
  EXPECT_NEAR(last["p_m"][2].get<double>(), -0.9, 0.03);
}

TEST(MountTest, GravityIsComparedWithTheMounting) {
  Config config;
  config.mount.T_base_sensor.rotation = so3_exp({0, 0.5, 0});
  TestDaemon daemon(config);
  const ImuPacketWriter writer(daemon.info());
  Bytes packet;
  for (int i = 0; i < 120; ++i) {
    const SensorTime time{1'000'000'000 + i * std::int64_t{10'000'000}};
    const ImuSample sample{time, time, {0.0, 0.0, 9.81}, Eigen::Vector3d::Zero()};
    writer.write({&sample, 1}, 0, 0, packet);
    daemon.source().feed(packet);
  }
  std::fill(packet.begin(), packet.end(), std::byte{0xFF});  // Not a number.
  daemon.source().feed(packet);
  ASSERT_TRUE(daemon.wait_for("get_status",
                              [](const Json& s) { return s["counters"]["bad_imu_packets"] == 1; }));
  Client client(daemon.address());
  const Json status = client.call("get_status");
  EXPECT_EQ(status["counters"]["imu_packets"], 120);
  EXPECT_NEAR(status["imu"]["rate_hz"].get<double>(), 100.0, 0.5);
  EXPECT_NEAR(status["imu"]["gravity_mps2"][2].get<double>(), 9.81, 1e-3);
  EXPECT_NEAR(status["imu"]["mount_tilt_deg"].get<double>(), 0.5 * 180.0 / M_PI, 1e-3);
}

}  // namespace
}  // namespace glint::daemon
