// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The daemon over real TCP, with a fake sensor.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "daemon/test_daemon.hpp"
#include "driver/core/scan_assembler.hpp"
#include "slam/frontend.hpp"

namespace glint::daemon {
namespace {

using test::Bytes;
using test::has_poses;
using test::room_packets;
using test::TestDaemon;
using namespace std::chrono_literals;

/// What `glint replay` would estimate: no threads, no clock.
std::vector<slam::OdometryEstimate> replay(const SensorInfo& info,
                                           const std::vector<Bytes>& packets) {
  ScanAssembler assembler(info);
  slam::Frontend frontend(info, {});
  std::vector<slam::OdometryEstimate> estimates;
  for (const Bytes& packet : packets) {
    static_cast<void>(assembler.push(packet));
    while (const LidarScan* scan = assembler.next()) estimates.push_back(frontend.process(*scan));
  }
  return estimates;
}

TEST(DaemonTest, EverySubscribedPoseEqualsReplayBitForBit) {
  constexpr int kScans = 8;
  TestDaemon daemon;
  const auto packets = room_packets(daemon.info(), kScans);
  const auto expected = replay(daemon.info(), packets);
  ASSERT_EQ(expected.size(), kScans);
  ASSERT_EQ(expected.back().state, slam::TrackingState::kTracking);

  Client client(daemon.address());
  client.call("subscribe", {{"topics", {"pose"}}, {"frame", "odom"}});
  daemon.feed(packets);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Json pose = client.next_message(10s)["params"];
    const Pose& truth = expected[k].T_odom_sensor;
    EXPECT_EQ(pose["seq"], k);
    EXPECT_EQ(pose["missed"], 0);
    EXPECT_EQ(pose["frame_id"], expected[k].frame_id);
    EXPECT_EQ(pose["t_ns"].get<std::int64_t>(), expected[k].stamp.ns);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(pose["p_m"][i].get<double>(), truth.translation_m[static_cast<Eigen::Index>(i)]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(pose["q_xyzw"][i].get<double>(),
                truth.rotation.coeffs()[static_cast<Eigen::Index>(i)]);
    }
  }
}

TEST(DaemonTest, HelloAnnouncesOnlyMethodsThatExist) {
  TestDaemon daemon;
  Client client(daemon.address());
  EXPECT_EQ(client.hello()["protocol"], "1.0");
  EXPECT_EQ(client.hello()["max_line"], 1 << 20);
  for (const Json& feature : client.hello()["features"]) {
    const auto name = feature.get<std::string>();
    const auto dot = name.find('.');
    const Json params = name.starts_with("subscribe.") ? Json{{"topics", {name.substr(dot + 1)}}}
                                                       : Json{{"name", "office"}, {"token", "any"}};
    try {
      client.call(name.substr(0, dot), params);
    } catch (const ReplyError& error) {
      const bool needs_place = (name.find("_map") != std::string::npos && name != "get_map") ||
                               name == "relocalize" || name == "set_initial_pose";
      const bool needs_scan = name == "get_image";
      EXPECT_TRUE(needs_place || needs_scan) << name;
      EXPECT_EQ(error.error()["data"].value("code", ""),
                needs_scan ? "NOT_TRACKING" : "NOT_CONFIGURED")
          << name;
    }
  }
}

TEST(DaemonTest, BeforeTheFirstScanTheStateIsInitAndThereIsNoPose) {
  TestDaemon daemon;
  Client client(daemon.address());
  const Json pose = client.call("get_pose");
  EXPECT_EQ(pose["state"], "INIT");
  EXPECT_EQ(pose["sensor"], 0);
  EXPECT_FALSE(pose.contains("p_m"));
  EXPECT_EQ(client.call("get_status")["sensor_state"], "WAITING_DATA");
}

TEST(DaemonTest, AnAbsentSensorIsNoDeadThread) {
  TestDaemon daemon;
  std::this_thread::sleep_for(2200ms);
  EXPECT_TRUE(daemon.runtime().alive(2'000'000'000));
  EXPECT_EQ(daemon.runtime().fault(), "");
}

TEST(DaemonTest, SilenceReleasesTheUnfinishedScanAndItsPoseIsNotTracking) {
  TestDaemon daemon;
  auto packets = room_packets(daemon.info(), 5);
  packets.resize(packets.size() - 3);
  daemon.feed(packets);
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 5); }));
  ASSERT_TRUE(
      daemon.wait_for("get_status", [](const Json& s) { return s["sensor_state"] == "STALLED"; }));
  ASSERT_TRUE(daemon.wait_for("get_pose", [](const Json& p) { return p["stale"] == true; }));
  Client client(daemon.address());
  const Json pose = client.call("get_pose");
  EXPECT_EQ(pose["state"], "DEGRADED");
  EXPECT_GT(pose["age_ms"].get<double>(), 300.0);
  EXPECT_LT(pose["completeness"].get<double>(), 1.0);
}

TEST(DaemonTest, PoseAtATimeIsInterpolatedAndBeyondTheSpanRefused) {
  TestDaemon daemon;
  daemon.feed(room_packets(daemon.info(), 4));
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 4); }));
  Client client(daemon.address());
  const Json poses = client.call("get_trajectory")["poses"];
  ASSERT_EQ(poses.size(), 4U);
  const auto t1 = poses[1]["t_ns"].get<std::int64_t>();
  const auto t2 = poses[2]["t_ns"].get<std::int64_t>();
  const Json middle = client.call("get_pose", {{"at_ns", (t1 + t2) / 2}});
  const double x1 = poses[1]["p_m"][0].get<double>();
  const double x2 = poses[2]["p_m"][0].get<double>();
  EXPECT_NEAR(middle["p_m"][0].get<double>(), (x1 + x2) / 2, 1e-4);
  EXPECT_EQ(client.call("get_pose", {{"at", poses[1]["t"]}})["p_m"], poses[1]["p_m"]);
  try {
    client.call("get_pose", {{"at_ns", t1 - 10'000'000'000}});
    FAIL() << "a time outside the history was answered";
  } catch (const ReplyError& error) {
    EXPECT_EQ(error.error()["data"]["code"], "OUT_OF_RANGE");
    EXPECT_EQ(error.error()["data"]["from_ns"], poses[0]["t_ns"]);
  }
}

TEST(DaemonTest, TheMapHasThePointsThatStatusSays) {
  TestDaemon daemon;
  daemon.feed(room_packets(daemon.info(), 3));
  ASSERT_TRUE(daemon.wait_for(
      "get_status", [](const Json& s) { return has_poses(s, 3) && s["map"]["points"] > 0; }));
  Client client(daemon.address());
  const auto points = client.call("get_status")["map"]["points"].get<std::size_t>();
  std::size_t got = 0;
  Json params{{"encoding", "json"}};
  while (true) {
    const Json page = client.call("get_map", params);
    EXPECT_EQ(page["sensor"], 0);
    for (const Json& tile : page["tiles"]) got += tile["points"].size();
    if (!page.contains("next_cursor")) break;
    params["cursor"] = page["next_cursor"];
  }
  EXPECT_EQ(got, points);
}

/// One loop, at the second keyframe, which says that it is half a metre further and a little
/// turned.
slam::LoopSource loop_at_second_keyframe() {
  return {[](const slam::Keyframe& keyframe) {
    slam::LoopSearch found;
    if (keyframe.id != 1) return found;
    const Pose seen{so3_exp({0.0, 0.0, 0.1}), {1.0, 0.0, 0.0}};
    found.edges = {{0, 1, seen, Eigen::Matrix<double, 6, 6>::Identity() * 1e-6}};
    return found;
  }};
}

TEST(DaemonTest, ALoopMovesTheMapFrameWithItsEpochAndLeavesTheOdometryFrame) {
  constexpr int kScans = 16;  // a keyframe each half metre, which is each tenth scan
  RuntimeOptions options;
  options.loops = loop_at_second_keyframe;
  TestDaemon daemon({}, options);
  const auto packets = room_packets(daemon.info(), kScans);
  const auto expected = replay(daemon.info(), packets);
  Client client(daemon.address());
  client.call("subscribe", {{"topics", {"events"}}});
  daemon.feed(packets);

  std::map<std::string, Json> events;
  while (!events.contains("epoch")) {
    const Json event = client.next_message(10s)["params"];
    events[event["kind"].get<std::string>()] = event;
  }
  EXPECT_EQ(events["epoch"]["map_epoch"], 1);
  ASSERT_TRUE(events.contains("loop"));
  EXPECT_EQ(events["loop"]["from"], 0);
  EXPECT_EQ(events["loop"]["to"], 1);
  EXPECT_EQ(events["loop"]["accepted"], true);
  EXPECT_GT(events["loop"]["largest_correction_m"], 0.2);
  EXPECT_LT(events["loop"]["residual_after"]["distance_m"],
            events["loop"]["residual_before"]["distance_m"]);
  ASSERT_TRUE(events.contains("map"));
  EXPECT_EQ(events["map"]["map_epoch"], 1);

  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, kScans); }));
  Client reader(daemon.address());
  EXPECT_EQ(reader.hello()["map_epoch"], 1);
  const Json odom = reader.call("get_pose", {{"frame", "odom"}});
  const Json map = reader.call("get_pose", {{"frame", "map"}});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(odom["p_m"][i].get<double>(),
              expected.back().T_odom_sensor.translation_m[static_cast<Eigen::Index>(i)]);
  }
  EXPECT_GT(map["p_m"][0].get<double>(), odom["p_m"][0].get<double>() + 0.2);
  EXPECT_EQ(map["map_epoch"], 1);
  EXPECT_EQ(reader.call("get_map")["map_epoch"], 1);
  EXPECT_EQ(reader.call("get_status")["counters"]["loops_accepted"], 1);

  // The path to the first keyframe stays, that to the second is drawn out, and nothing jumps.
  const Json path = reader.call("get_trajectory")["poses"];
  ASSERT_EQ(path.size(), static_cast<std::size_t>(kScans));
  EXPECT_NEAR(path[0]["p_m"][0].get<double>(), 0.0, 1e-9);
  double largest_step_m = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const double step_m = path[k]["p_m"][0].get<double>() - path[k - 1]["p_m"][0].get<double>();
    largest_step_m = std::max(largest_step_m, step_m);
  }
  EXPECT_LT(largest_step_m, 0.15);
  EXPECT_EQ(reader.call("get_pose", {{"at", path[5]["t"]}})["p_m"], path[5]["p_m"]);
  EXPECT_EQ(path[kScans - 1]["p_m"], map["p_m"]);
}

TEST(DaemonTest, AQueryThatFailsOnTheWorkerIsAnErrorOfItsOwn) {
  RuntimeOptions options;
  options.loops = loop_at_second_keyframe;
  TestDaemon daemon({}, options);
  daemon.feed(room_packets(daemon.info(), 16));
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return s["map_epoch"] == 1; }));
  Client client(daemon.address());
  try {
    client.call("get_map", {{"cursor", "1:0:0:0:0"}});
    FAIL() << "a cursor from before a correction was taken";
  } catch (const ReplyError& error) {
    EXPECT_EQ(error.error()["data"]["code"], "OUT_OF_RANGE");
  }
  EXPECT_EQ(daemon.runtime().fault(), "");
  EXPECT_FALSE(client.call("get_map")["tiles"].empty());
}

TEST(DaemonTest, PauseHoldsThePoseAndResumeGoesOn) {
  TestDaemon daemon;
  const auto packets = room_packets(daemon.info(), 6);
  const auto half = packets.begin() + static_cast<std::ptrdiff_t>(packets.size() / 2);
  daemon.feed({packets.begin(), half});
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 3); }));
  Client client(daemon.address());
  EXPECT_EQ(client.call("pause")["accepted"], true);
  ASSERT_TRUE(daemon.wait_for("get_pose", [](const Json& p) { return p["state"] == "PAUSED"; }));
  daemon.feed({half, packets.end()});
  ASSERT_TRUE(daemon.wait_for("get_status",
                              [](const Json& s) { return s["counters"]["paused_scans"] == 3; }));
  EXPECT_TRUE(has_poses(client.call("get_status"), 3));
  client.call("resume");
  ASSERT_TRUE(daemon.wait_for("get_pose", [](const Json& p) { return p["state"] != "PAUSED"; }));
}

TEST(DaemonTest, ResetStartsANewSegment) {
  TestDaemon daemon;
  const auto packets = room_packets(daemon.info(), 6);
  const auto half = packets.begin() + static_cast<std::ptrdiff_t>(packets.size() / 2);
  daemon.feed({packets.begin(), half});
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 3); }));
  Client client(daemon.address());
  client.call("reset_odometry");
  daemon.feed({half, packets.end()});
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 6); }));
  EXPECT_EQ(client.call("get_pose")["segment"], 1);
}

TEST(DaemonTest, ForeignDatagramsAreCountedAndHarmNothing) {
  TestDaemon daemon;
  auto packets = room_packets(daemon.info(), 2);
  packets.insert(packets.begin() + 5, Bytes(100));
  packets.insert(packets.begin() + 9, Bytes(48));
  packets.insert(packets.begin() + 12, Bytes());
  daemon.feed(packets);
  ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 2); }));
  Client client(daemon.address());
  const Json counters = client.call("get_status")["counters"];
  EXPECT_EQ(counters["bad_size"], 2);
  EXPECT_EQ(counters["imu_packets"], 1);
  EXPECT_EQ(counters["incomplete_scans"], 0);
}

TEST(DaemonTest, StatusNotificationsCome) {
  TestDaemon daemon;
  Client client(daemon.address());
  const Json echo = client.call("subscribe", {{"topics", {"status"}}, {"rate_hz", 50}});
  EXPECT_EQ(echo["settings"]["status"]["rate_hz"], 10.0) << "the effective rate is told";
  for (int seq = 0; seq < 2; ++seq) {
    const Json message = client.next_message(5s);
    EXPECT_EQ(message["method"], "status");
    EXPECT_EQ(message["params"]["seq"], seq);
  }
}

TEST(DaemonTest, TheSessionFileIsFinishedAtStop) {
  const auto file = std::filesystem::path(testing::TempDir()) / "daemon_test.glint";
  {
    RuntimeOptions options;
    options.session.file = file;
    TestDaemon daemon({}, options);
    daemon.feed(room_packets(daemon.info(), 2));
    ASSERT_TRUE(daemon.wait_for("get_status", [](const Json& s) { return has_poses(s, 2); }));
  }
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file.string() + "-wal")) << "the database was not closed";
}

}  // namespace
}  // namespace glint::daemon
