// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The daemon with an emulated sensor: HTTP, UDP and TCP over loopback.
#include "daemon/sensor_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/test_live_daemon.hpp"

namespace glint::daemon {
namespace {

using test::LiveDaemon;
using test::room_sensor;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

bool runs_with_poses(const Json& status, int count) {
  return status["sensor_state"] == "RUNNING" && status["counters"]["poses"] >= count;
}

/// The `message` of every event so far.
std::vector<std::string> event_messages(Runtime& runtime) {
  std::vector<std::string> messages;
  std::uint64_t cursor = 0;
  while (const auto event = runtime.events().next(cursor)) {
    messages.push_back(event->fields.value("message", ""));
  }
  return messages;
}

TEST(SensorLinkTest, ASensorThatComesLaterIsConfiguredAndGivesPoses) {
  LiveDaemon daemon;
  daemon.emulator_options().powered = false;
  daemon.config().sensor.timestamp_mode = "TIME_FROM_PTP_1588";
  daemon.start();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["sensor_session"]["failures"] > 1; }));
  const Json before = daemon.status();
  EXPECT_EQ(before["state"], "INIT");
  EXPECT_EQ(before["sensor_state"], "DISCOVERING");
  EXPECT_THAT(before["sensor_session"]["failure"].get<std::string>(),
              StartsWith("DISCOVERING: 127.0.0.1 refuses connections"));
  EXPECT_LT(before["sensor_session"]["state_age_s"].get<double>(), 10.0);
  daemon.power_on();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return runs_with_poses(s, 3); }));
  const Json session = daemon.status()["sensor_session"];
  EXPECT_FALSE(session.contains("failure"));
  EXPECT_EQ(session["serial_number"], room_sensor().serial_number);
  EXPECT_EQ(session["address"], "127.0.0.1");
  EXPECT_EQ(session["config_writes"], 1);
  EXPECT_EQ(daemon.sensor_settings()["udp_port_lidar"], daemon.udp_port());
  EXPECT_EQ(daemon.sensor_settings()["timestamp_mode"], "TIME_FROM_PTP_1588");
  EXPECT_EQ(daemon.sensor_counts().flash_writes, 0U);
}

TEST(SensorLinkTest, ARestartHasAllAppliedAnewAndTheMapIsKept) {
  LiveDaemon daemon;
  daemon.start();
  ASSERT_TRUE(daemon.reaches(
      [](const Json& s) { return runs_with_poses(s, 3) && s["map"]["keyframes"] > 0; }));
  const Json before = daemon.status();
  daemon.restart_sensor();
  EXPECT_EQ(daemon.sensor_settings()["udp_dest"], "127.0.0.9") << "it has forgotten all";
  ASSERT_TRUE(daemon.reaches([&](const Json& s) {
    return s["sensor_session"]["config_writes"] == 2 &&
           runs_with_poses(s, before["counters"]["poses"].get<int>() + 5);
  }));
  const Json after = daemon.status();
  EXPECT_EQ(daemon.sensor_settings()["udp_dest"], "127.0.0.1");
  EXPECT_EQ(after["sensor_session"]["restarts"], 1);
  EXPECT_EQ(after["counters"]["sensor_restarts"], 1) << "as the packets tell it";
  EXPECT_GE(after["map"]["points"], before["map"]["points"]);
  EXPECT_EQ(after["odometry"]["segment"], 0) << "it stands where it stood";
}

TEST(SensorLinkTest, ASensorThatIsAsWantedGetsNoWriteAtAll) {
  LiveDaemon daemon;
  daemon.set_flash(LiveDaemon::metadata(room_sensor(), daemon.sends_here()));
  daemon.start();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return runs_with_poses(s, 3); }));
  daemon.restart_sensor();
  ASSERT_TRUE(daemon.reaches([](const Json& s) {
    return s["sensor_session"]["restarts"] == 1 && s["sensor_state"] == "RUNNING";
  }));
  EXPECT_EQ(daemon.sensor_counts().config_writes, 0U);
  EXPECT_EQ(daemon.sensor_counts().reinitialises, 0U);
}

TEST(SensorLinkTest, ASensorThatIsToBeLeftAloneGetsNoWriteEver) {
  LiveDaemon daemon;
  daemon.config().sensor.configure = false;
  daemon.config().sensor.lidar_mode = "2048x10";
  auto settings = daemon.sends_here();
  settings["udp_port_lidar"] = 9;
  daemon.set_flash(LiveDaemon::metadata(room_sensor(), settings));
  daemon.start();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["sensor_session"]["failures"] > 0; }));
  EXPECT_THAT(daemon.status()["sensor_error"].get<std::string>(),
              AllOf(HasSubstr("lidar packets to port 9,"), HasSubstr("sensor.lidar_port = 9")));
  daemon.restart_sensor();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["sensor_session"]["failures"] > 1; }));
  EXPECT_EQ(daemon.sensor_counts().config_writes, 0U);
}

TEST(SensorLinkTest, AnotherModeAfterARestartIsANewSegmentInTheSameMap) {
  LiveDaemon daemon;
  daemon.set_flash(LiveDaemon::metadata(room_sensor(), daemon.sends_here()));
  daemon.start();
  ASSERT_TRUE(daemon.reaches(
      [](const Json& s) { return runs_with_poses(s, 3) && s["map"]["keyframes"] > 0; }));
  const Json before = daemon.status();
  const SensorInfo finer = test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 64, 1024);
  daemon.replace_sensor(finer, LiveDaemon::metadata(finer, daemon.sends_here()));
  ASSERT_TRUE(daemon.reaches([&](const Json& s) {
    return s["odometry"]["segment"] == 1 && s["state"] == "TRACKING" &&
           s["map"]["keyframes"] > before["map"]["keyframes"];
  }));
  const Json after = daemon.status();
  // Those that came before the new metadata wait (`early_packets`), if any did.
  EXPECT_EQ(after["counters"]["bad_columns"], 0) << "packets of the new mode went to the old one";
  EXPECT_EQ(daemon.runtime().sensor()->columns_per_frame, 1024);
  EXPECT_THAT(event_messages(daemon.runtime()),
              testing::Contains(HasSubstr("lidar_mode 512x10 -> 1024x10")));
}

TEST(SensorLinkTest, SilenceIsAStallAndItsEndIsTold) {
  LiveDaemon daemon;
  daemon.start();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return runs_with_poses(s, 3); }));
  daemon.streamer().set_muted(true);
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["sensor_state"] == "STALLED"; }));
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["sensor_session"]["failures"] > 0; }));
  EXPECT_THAT(daemon.status()["sensor_session"]["failure"].get<std::string>(),
              AllOf(StartsWith("STALLED: "), HasSubstr("firewall")));
  EXPECT_TRUE(daemon.runtime().alive(2'000'000'000)) << "no thread waits for the sensor";
  daemon.streamer().set_muted(false);
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["sensor_state"] == "RUNNING"; }));
  EXPECT_THAT(
      event_messages(daemon.runtime()),
      testing::IsSupersetOf({HasSubstr("packets of 127.0.0.1 arrive"),
                             HasSubstr("no packet of 127.0.0.1 for"), HasSubstr("STALLED: ")}));
}

TEST(SensorLinkTest, MetadataOfAnotherSensorAreRefusedWithBothSerialNumbers) {
  LiveDaemon daemon;
  SensorInfo other = room_sensor();
  other.serial_number = "122201000111";
  daemon.start(other);
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return s["counters"]["bad_serial"] > 0; }));
  const Json status = daemon.status();
  EXPECT_EQ(status["counters"]["poses"], 0);
  EXPECT_THAT(status["sensor_error"].get<std::string>(),
              AllOf(HasSubstr("122201000111"), HasSubstr(room_sensor().serial_number)));
}

TEST(SensorLinkTest, AlertsAndTelemetryAreInTheStatus) {
  LiveDaemon daemon;
  daemon.start();
  ASSERT_TRUE(daemon.reaches([](const Json& s) { return runs_with_poses(s, 1); }));
  daemon.raise_alert("0x0100000e", "OVERTEMP", "hot");
  ASSERT_TRUE(daemon.reaches(
      [](const Json& s) { return s["sensor_session"]["health"]["overheating"] == true; }));
  const Json health = daemon.status()["sensor_session"]["health"];
  EXPECT_EQ(health["alerts"][0]["id"], "0x0100000e");
  EXPECT_EQ(health["telemetry"]["temperature_degc"], 45.0);
  EXPECT_EQ(health["ptp"]["locked"], false);
  EXPECT_EQ(daemon.status()["packet_health"]["shot_limiting_state"], 0);
}

}  // namespace
}  // namespace glint::daemon
