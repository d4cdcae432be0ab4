// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A session with an emulated sensor over loopback, in each form of the interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "driver/core/sensor_info.hpp"
#include "driver/core/time.hpp"
#include "driver/emulator/sensor_emulator.hpp"
#include "driver/emulator/test_metadata.hpp"
#include "driver/session/network_client.hpp"
#include "driver/session/session_runner.hpp"

namespace glint::emulator {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using namespace std::chrono_literals;

constexpr std::int64_t kMs_ns = 1'000'000;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

Clock steady_clock() {
  Clock clock;
  clock.monotonic_ns = &now_ns;
  return clock;
}

/// A sensor, and a session with it, that are a hundred times as fast as real ones.
class SessionOverNetworkTest : public testing::Test {
 protected:
  SessionOverNetworkTest() {
    emulator_options_.sensor.metadata_json = test::metadata();
    emulator_options_.sensor.firmware = "v3.1.0";
    emulator_options_.sensor.reinitialise_ns = 20 * kMs_ns;
    emulator_options_.sensor.boot_ns = 30 * kMs_ns;
    session_options_.wanted.emplace();
    session_options_.wanted->lidar_mode = "1024x10";
    session_options_.wanted->udp_dest = "@auto";
    SessionTimes& times = session_options_.times;
    times.first_retry_ns = 5 * kMs_ns;
    times.longest_retry_ns = 20 * kMs_ns;
    times.initialising_poll_ns = 5 * kMs_ns;
    times.initialising_limit_ns = 1000 * kMs_ns;
    times.first_packet_limit_ns = 150 * kMs_ns;
    times.stall_ns = 30 * kMs_ns;
    times.reconfigure_ns = 60 * kMs_ns;
    times.health_period_ns = 20 * kMs_ns;
    times.packet_look_ns = 5 * kMs_ns;
  }

  void start_emulator() {
    emulator_.emplace(io_, emulator_options_, steady_clock(),
                      [this](const EmulatedStream& stream) { stream_ = stream; });
  }

  void start_session() {
    runner_.reset();
    session_.reset();
    session_options_.host = "127.0.0.1";
    client_.emplace(io_, SensorAddress{"127.0.0.1", emulator_->http_port(), emulator_->tcp_port()},
                    ClientTimeouts{200ms, 200ms});
    session_.emplace(
        *client_, session_options_, [this] { return activity(); },
        SessionListener{[this](const std::string& text) { metadata_ = text; }, {}});
    runner_.emplace(io_, *session_, steady_clock());
  }

  /// Packets arrive while the sensor sends them here.
  PacketActivity activity() {
    const bool here = stream_.sending && stream_.destination == "127.0.0.1" && packets_pass_;
    if (here) activity_ = {now_ns(), stream_.init_id};
    return activity_;
  }

  template <class Condition>
  bool run_until(Condition condition) {
    const std::int64_t limit_ns = now_ns() + 3000 * kMs_ns;
    while (!condition() && now_ns() < limit_ns) io_.run_one_for(5ms);
    return condition();
  }

  bool run_until(SessionState state) {
    return run_until([&] { return session_->status().state == state; });
  }

  /// For a time in which nothing should happen.
  void run_for(std::int64_t duration_ns) {
    const std::int64_t end_ns = now_ns() + duration_ns;
    while (now_ns() < end_ns) io_.run_one_for(5ms);
  }

  bool fails_with(const std::string& text) {
    return run_until([&] { return session_->status().failure.find(text) != std::string::npos; });
  }

  boost::asio::io_context io_;
  SensorEmulatorOptions emulator_options_;
  SessionOptions session_options_;
  EmulatedStream stream_;
  bool packets_pass_ = true;
  PacketActivity activity_;
  std::string metadata_;
  std::optional<SensorEmulator> emulator_;
  std::optional<NetworkSensorClient> client_;
  std::optional<SensorSession> session_;
  std::optional<SessionRunner> runner_;
};

class EveryFormTest : public SessionOverNetworkTest,
                      public testing::WithParamInterface<const char*> {
 protected:
  EveryFormTest() { emulator_options_.sensor.firmware = GetParam(); }
};

std::string test_name(const testing::TestParamInfo<const char*>& firmware) {
  std::string name = firmware.param;
  std::ranges::replace(name, '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Firmware, EveryFormTest,
                         testing::Values("v1.13.0", "v2.0.0", "v2.1.2", "v2.5.0", "v3.1.0",
                                         "v4.0.0"),
                         test_name);

TEST_P(EveryFormTest, IsConfiguredAndRunsWithoutAWriteToFlash) {
  start_emulator();
  start_session();
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  const EmulatedSensor& sensor = emulator_->sensor();
  EXPECT_EQ(client_->form(), sensor.form());
  EXPECT_EQ(sensor.config().active()["lidar_mode"], "1024x10");
  EXPECT_EQ(stream_.destination, "127.0.0.1");
  EXPECT_EQ(sensor.counts().reinitialises, 1U);
  EXPECT_EQ(sensor.counts().flash_writes, 0U);
  EXPECT_EQ(parse_sensor_info(metadata_, "emulated").serial_number, "122246000293");
  EXPECT_EQ(session_->status().unmet.size(), 0U);
}

TEST_P(EveryFormTest, ASensorThatIsAsWantedGetsNoWriteAtAll) {
  auto metadata = nlohmann::json::parse(test::metadata());
  metadata["config_params"]["udp_dest"] = "127.0.0.1";
  metadata["config_params"]["lidar_mode"] = "1024x10";
  emulator_options_.sensor.metadata_json = metadata.dump();
  start_emulator();
  start_session();
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  run_for(60 * kMs_ns);
  EXPECT_EQ(emulator_->sensor().counts().config_writes, 0U);
  EXPECT_EQ(emulator_->sensor().counts().reinitialises, 0U);
}

TEST_P(EveryFormTest, ARestartWhileRunningHasAllAppliedAnew) {
  start_emulator();
  start_session();
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  emulator_->restart();
  EXPECT_EQ(emulator_->sensor().config().active()["lidar_mode"], "512x10");
  ASSERT_TRUE(run_until([&] { return emulator_->sensor().counts().reinitialises == 2U; }))
      << session_->status().failure;
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  EXPECT_EQ(emulator_->sensor().config().active()["lidar_mode"], "1024x10");
  EXPECT_EQ(emulator_->sensor().counts().flash_writes, 0U);
}

TEST_F(SessionOverNetworkTest, StartsBeforeTheSensorHasPower) {
  emulator_options_.powered = false;
  start_emulator();
  start_session();
  ASSERT_TRUE(fails_with("DISCOVERING: 127.0.0.1 refuses connections on port"));
  emulator_->power_on();
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  EXPECT_EQ(session_->status().failure, "");
}

TEST_F(SessionOverNetworkTest, APowerLossIsAStallAndThenADiscovery) {
  start_emulator();
  start_session();
  ASSERT_TRUE(run_until(SessionState::kRunning));
  emulator_->power_off();
  ASSERT_TRUE(run_until(SessionState::kStalled));
  ASSERT_TRUE(fails_with("STALLED: 127.0.0.1 refuses connections"));
  emulator_->power_on();
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  EXPECT_EQ(emulator_->sensor().config().active()["lidar_mode"], "1024x10");
}

TEST_F(SessionOverNetworkTest, PersistsWhenAsked) {
  session_options_.persist = true;
  start_emulator();
  start_session();
  ASSERT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  EXPECT_EQ(emulator_->sensor().config().persisted()["lidar_mode"], "1024x10");
}

TEST_F(SessionOverNetworkTest, EachFaultIsNamedWithItsStepAndPassesWhenItEnds) {
  const std::vector<std::pair<ControlFault, std::string>> faults = {
      {ControlFault::kServerError, "answered 500 to GET /api/v1/sensor/config"},
      {ControlFault::kSlow, "did not answer GET /api/v1/sensor/config within 0.2 s"},
      {ControlFault::kGarbage, "with something that is not HTTP"},
      {ControlFault::kNoJson, "which is not JSON"},
      {ControlFault::kHalfAnswer, "broke off the answer to GET /api/v1/sensor/config"}};
  start_emulator();
  for (const auto& [fault, said] : faults) {
    emulator_->inject({fault, 2, "/sensor/config"});
    start_session();
    EXPECT_TRUE(fails_with(said)) << said << ": " << session_->status().failure;
    EXPECT_THAT(session_->status().failure, StartsWith("CONFIGURING: 127.0.0.1 "));
    EXPECT_TRUE(run_until(SessionState::kRunning)) << session_->status().failure;
  }
}

TEST_F(SessionOverNetworkTest, ARefusedSettingIsToldInTheSensorsWords) {
  session_options_.wanted->lidar_mode = "3x3";
  start_emulator();
  start_session();
  ASSERT_TRUE(fails_with("answered 400 to POST /api/v1/sensor/config?"));
  EXPECT_THAT(session_->status().failure,
              AllOf(StartsWith("CONFIGURING: "), HasSubstr("lidar_mode cannot be")));
}

TEST_F(SessionOverNetworkTest, PacketsThatDoNotArriveArePutDownToTheFirewall) {
  packets_pass_ = false;
  start_emulator();
  start_session();
  EXPECT_TRUE(fails_with("WAITING_DATA: no packets of 127.0.0.1 although it sends them here"));
}

TEST_F(SessionOverNetworkTest, AlertsTelemetryPtpAndTimeAreSeen) {
  start_emulator();
  start_session();
  ASSERT_TRUE(run_until(SessionState::kRunning));
  emulator_->raise_alert("0x0100000e", "OVERTEMP", "hot");
  ASSERT_TRUE(run_until([&] { return session_->status().health.overheating; }));
  const SensorHealth& health = session_->status().health;
  ASSERT_TRUE(run_until([&] { return health.time.has_value(); }));
  EXPECT_EQ(health.telemetry.value().temperature_degc, 45.0);
  EXPECT_EQ(health.time->mode, "TIME_FROM_INTERNAL_OSC");
  EXPECT_FALSE(health.ptp.value().locked);
  emulator_->clear_alerts();
  EXPECT_TRUE(run_until([&] { return health.alerts.empty(); }));
}

TEST_F(SessionOverNetworkTest, AnUnknownNameIsSaidToBeOne) {
  NetworkSensorClient client(io_, {"no-such-sensor.invalid", 80, 7501}, {3000ms, 3000ms});
  std::string failure;
  client.read(SensorResource::kSensorInfo,
              [&](const SensorReply& reply) { failure = reply.failure; });
  ASSERT_TRUE(run_until([&] { return !failure.empty(); }));
  EXPECT_THAT(failure, HasSubstr("no-such-sensor.invalid"));
}

TEST_F(SessionOverNetworkTest, ACancelledQuestionIsNotAnswered) {
  start_emulator();
  emulator_->inject({ControlFault::kSlow, 1, {}});
  NetworkSensorClient client(io_, {"127.0.0.1", emulator_->http_port(), emulator_->tcp_port()},
                             {50ms, 50ms});
  bool answered = false;
  client.read(SensorResource::kSensorInfo, [&](const SensorReply&) { answered = true; });
  run_for(10 * kMs_ns);
  client.cancel();
  run_for(80 * kMs_ns);
  EXPECT_FALSE(answered);
}

}  // namespace
}  // namespace glint::emulator
