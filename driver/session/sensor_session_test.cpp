// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The session's states, by a clock that stands still and a sensor that answers when told.
#include "driver/session/sensor_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "driver/core/error.hpp"

namespace glint {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr std::int64_t kMs_ns = 1'000'000;

/// A sensor that answers at once, or not at all.
class FakeClient final : public SensorClient {
 public:
  void read(SensorResource resource, Handler handler) override {
    if (resource == SensorResource::kSensorInfo) ++looks;
    if (silent) return;
    SensorReply reply;
    reply.local_address = "10.0.0.1";
    reply.failure = resource == fails ? "sensor answered 404 to GET /x; do this" : failure;
    if (reply.failure.empty()) reply.value = value_of(resource);
    handler(std::move(reply));
  }

  void write_config(const json& changes, bool persist, Handler handler) override {
    writes.push_back(changes);
    persisted = persisted || persist;
    SensorReply reply;
    reply.failure = failure;
    if (takes_settings) active.update(changes);
    if (active["udp_dest"] == "@auto") active["udp_dest"] = "10.0.0.1";
    auto& init_id = info["initialization_id"];
    if (!init_id.is_null()) init_id = init_id.get<int>() + 1;
    handler(std::move(reply));
  }

  void cancel() override { ++cancels; }

  json info = {{"prod_line", "OS-1-64"},
               {"prod_sn", "122"},
               {"build_rev", "v3.1.0"},
               {"status", "RUNNING"},
               {"initialization_id", 7}};
  json active = {{"lidar_mode", "512x10"}, {"udp_dest", "10.0.0.9"}, {"udp_port_lidar", 7502}};
  json alerts = {{"active", json::array()}};
  std::string failure;  ///< Of every answer.
  std::optional<SensorResource> fails;
  bool silent = false;
  bool takes_settings = true;
  std::vector<json> writes;
  bool persisted = false;
  int looks = 0;
  int cancels = 0;

 private:
  json value_of(SensorResource resource) const {
    switch (resource) {
      case SensorResource::kSensorInfo:
        return info;
      case SensorResource::kActiveConfig:
        return active;
      case SensorResource::kMetadata:
        return {{"sensor_info", info}, {"config_params", active}};
      case SensorResource::kAlerts:
        return alerts;
      default:
        return json::object();
    }
  }
};

class SensorSessionTest : public testing::Test {
 protected:
  SensorSessionTest() {
    options_.host = "os-1221.local";
    options_.wanted.emplace();
    options_.wanted->lidar_mode = "1024x10";
    options_.wanted->udp_dest = "@auto";
  }

  SensorSession& session() {
    if (!session_) {
      session_.emplace(
          client_, options_, [this] { return packets_; },
          SessionListener{
              [this](const std::string& text) { metadata_.push_back(text); },
              [this](SessionState, const std::string& text) { news_.push_back(text); }});
    }
    return *session_;
  }

  /// Lets time pass in steps of 50 ms, with packets arriving in each or none.
  SessionState run(std::int64_t duration_ms, bool packets = false) {
    for (std::int64_t end_ns = now_ns_ + duration_ms * kMs_ns; now_ns_ < end_ns;) {
      now_ns_ += 50 * kMs_ns;
      if (packets) packets_.last_packet_ns = now_ns_;
      session().step(now_ns_);
    }
    return session().status().state;
  }

  const SessionStatus& status() { return session().status(); }

  FakeClient client_;
  SessionOptions options_;
  PacketActivity packets_;
  std::vector<std::string> metadata_;
  std::vector<std::string> news_;
  std::int64_t now_ns_ = kNsPerSecond;
  std::optional<SensorSession> session_;
};

TEST_F(SensorSessionTest, WritesOnlyWhatDiffersAndRunsWhenPacketsCome) {
  options_.wanted->udp_port_lidar = 7502;
  EXPECT_EQ(run(2000), SessionState::kWaitingData);
  EXPECT_THAT(client_.writes, ElementsAre(json{{"lidar_mode", "1024x10"}, {"udp_dest", "@auto"}}));
  EXPECT_FALSE(client_.persisted);
  EXPECT_THAT(status().last_changes,
              ElementsAre("lidar_mode: 512x10 -> 1024x10", "udp_dest: 10.0.0.9 -> @auto"));
  ASSERT_EQ(metadata_.size(), 1U);
  EXPECT_THAT(metadata_[0], HasSubstr("1024x10"));
  EXPECT_EQ(run(100, true), SessionState::kRunning);
  EXPECT_EQ(status().failure, "");
  EXPECT_EQ(status().serial_number, "122");
}

TEST_F(SensorSessionTest, ASensorThatIsAsWantedIsLeftAlone) {
  client_.active.update({{"lidar_mode", "1024x10"}, {"udp_dest", "10.0.0.1"}});
  EXPECT_EQ(run(500), SessionState::kWaitingData);
  EXPECT_THAT(client_.writes, IsEmpty());
}

TEST_F(SensorSessionTest, WithoutWantedSettingsNothingIsEverWritten) {
  options_.wanted.reset();
  run(500);
  EXPECT_EQ(run(60'000, true), SessionState::kRunning);
  EXPECT_THAT(client_.writes, IsEmpty());
}

TEST_F(SensorSessionTest, NeverGivesUpOnASensorWithoutPowerAndBacksOffToACap) {
  client_.failure = "os-1221.local refuses connections";
  EXPECT_EQ(run(3'600'000), SessionState::kDiscovering);
  EXPECT_GT(client_.looks, 3600 / 11);
  EXPECT_LT(client_.looks, 3600 / 9);
  EXPECT_EQ(status().failure, "DISCOVERING: os-1221.local refuses connections");
  EXPECT_EQ(news_.size(), 1U) << "said once, not each time";
  client_.failure.clear();
  EXPECT_EQ(run(12'000, true), SessionState::kRunning);
  EXPECT_EQ(status().failure, "");
}

TEST_F(SensorSessionTest, AFailureNamesItsStep) {
  client_.fails = SensorResource::kActiveConfig;
  run(100);
  EXPECT_EQ(status().failure, "CONFIGURING: sensor answered 404 to GET /x; do this");
  EXPECT_THAT(news_.back(), StartsWith("CONFIGURING: "));
}

TEST_F(SensorSessionTest, WaitsForASensorThatInitialises) {
  client_.info["status"] = "INITIALIZING";
  EXPECT_EQ(run(20'000), SessionState::kDiscovering);
  EXPECT_EQ(status().failures, 0U);
  client_.info["status"] = "RUNNING";
  EXPECT_EQ(run(2000), SessionState::kWaitingData);
}

TEST_F(SensorSessionTest, ASensorThatInitialisesForEverIsReported) {
  client_.info["status"] = "INITIALIZING";
  run(95'000);
  EXPECT_THAT(status().failure, StartsWith("DISCOVERING: os-1221.local stays INITIALIZING"));
}

TEST_F(SensorSessionTest, AllIsAppliedAnewAfterARestart) {
  run(2000);
  run(1000, true);
  client_.info["initialization_id"] = 99;
  client_.active["lidar_mode"] = "512x10";
  client_.active["udp_dest"] = "10.0.0.9";
  EXPECT_EQ(run(10'000, true), SessionState::kRunning);
  EXPECT_EQ(status().restarts, 1U);
  EXPECT_EQ(client_.writes.size(), 2U);
  EXPECT_EQ(client_.writes[0], client_.writes[1]);
  EXPECT_EQ(metadata_.size(), 2U);
}

TEST_F(SensorSessionTest, AForeignInitIdInPacketsIsCheckedAtOnceWithTheSensor) {
  run(2000);
  run(1000, true);
  const int looks = client_.looks;
  packets_.init_id = 1234;  // A straggler: the sensor has not restarted.
  run(200, true);
  EXPECT_EQ(client_.looks, looks + 1);
  EXPECT_EQ(status().restarts, 0U);
  client_.info["initialization_id"] = 55;
  packets_.init_id = 55;
  run(100, true);
  EXPECT_EQ(status().restarts, 1U);
}

TEST_F(SensorSessionTest, SilenceIsAStallAndItsEndIsNotARestart) {
  run(2000);
  run(1000, true);
  EXPECT_EQ(run(400), SessionState::kStalled);
  EXPECT_EQ(run(100, true), SessionState::kRunning);
  EXPECT_EQ(status().restarts, 0U);
  EXPECT_EQ(client_.writes.size(), 1U);
}

TEST_F(SensorSessionTest, ALongStallHasEverythingDoneAnew) {
  run(2000);
  run(1000, true);
  client_.active["udp_dest"] = "10.0.0.9";
  run(11'000);
  EXPECT_THAT(status().failure, StartsWith("STALLED: "));
  run(2000);
  EXPECT_EQ(client_.writes.back(), json({{"udp_dest", "@auto"}}));
  EXPECT_EQ(run(100, true), SessionState::kRunning);
}

TEST_F(SensorSessionTest, WithoutInitIdsReturningPacketsHaveTheSettingsChecked) {
  client_.active.update({{"lidar_mode", "1024x10"}, {"udp_dest", "10.0.0.1"}});
  client_.info["initialization_id"] = nullptr;
  run(500);
  run(1000, true);
  run(400);
  client_.active["lidar_mode"] = "512x10";
  EXPECT_EQ(run(3000, true), SessionState::kRunning);
  EXPECT_EQ(status().restarts, 0U);
  EXPECT_EQ(client_.writes.size(), 1U);
}

TEST_F(SensorSessionTest, SaysWhyNoPacketsCome) {
  options_.wanted.reset();
  run(10'500);
  EXPECT_THAT(status().failure, StartsWith("WAITING_DATA: "));
  EXPECT_THAT(status().failure, HasSubstr("sends them to 10.0.0.9, and this machine is 10.0.0.1"));
}

TEST_F(SensorSessionTest, AnUnreachableDestinationIsNamedByItsAlert) {
  client_.alerts["active"] = {{{"id", kLidarUnreachableAlert}, {"category", "UDP_TRANSMISSION"}}};
  run(12'500);
  EXPECT_THAT(status().failure, HasSubstr("0x01000015"));
  ASSERT_EQ(status().health.alerts.size(), 1U);
}

TEST_F(SensorSessionTest, AMulticastGroupIsNoWrongAddress) {
  options_.wanted->udp_dest = "239.0.0.5";
  run(12'500);
  EXPECT_THAT(status().failure, HasSubstr("to the group 239.0.0.5, to UDP port 7502"));
}

TEST_F(SensorSessionTest, StandbyIsNamedAsTheReason) {
  client_.info["status"] = "STANDBY";
  run(12'500);
  EXPECT_THAT(status().failure, HasSubstr("operating_mode to NORMAL"));
}

TEST_F(SensorSessionTest, ASettingThatDoesNotTakeIsToldAndNotWrittenAgain) {
  client_.takes_settings = false;
  client_.active["udp_dest"] = "10.0.0.1";
  run(2000);
  EXPECT_EQ(run(120'000, true), SessionState::kRunning);
  EXPECT_EQ(client_.writes.size(), 1U);
  EXPECT_THAT(status().unmet, ElementsAre("lidar_mode: 512x10 -> 1024x10"));
}

TEST_F(SensorSessionTest, PollsThatFailDoNotStopARunningSensor) {
  run(2000);
  run(1000, true);
  client_.failure = "os-1221.local broke off";
  EXPECT_EQ(run(30'000, true), SessionState::kRunning);
  EXPECT_EQ(status().health.failure, "os-1221.local broke off");
  client_.failure.clear();
  run(6000, true);
  EXPECT_EQ(status().health.failure, "");
}

TEST_F(SensorSessionTest, AnAnswerThatIsOverdueDoesNotHideAStall) {
  run(2000);
  run(1000, true);
  client_.silent = true;
  EXPECT_EQ(run(6000, true), SessionState::kRunning);
  EXPECT_EQ(run(500), SessionState::kStalled);
  EXPECT_GE(client_.cancels, 1);
}

TEST_F(SensorSessionTest, TellsWhenToCallAgain) {
  client_.failure = "off";
  EXPECT_EQ(session().step(now_ns_), now_ns_ + options_.times.first_retry_ns);
}

TEST_F(SensorSessionTest, SettingsThatNoSensorTakesAreRefusedAtOnce) {
  options_.wanted->udp_port_lidar = -1;
  EXPECT_THROW(session(), InputError);
}

}  // namespace
}  // namespace glint
