// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/emulated_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "driver/core/error.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/time.hpp"
#include "driver/emulator/test_metadata.hpp"

namespace glint::emulator {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::int64_t fake_now_ns = 0;

class EmulatedSensorTest : public testing::Test {
 protected:
  void start(const std::string& firmware) {
    EmulatedSensorOptions options;
    options.metadata_json = test::metadata();
    options.firmware = firmware;
    Clock clock;
    clock.monotonic_ns = [] { return fake_now_ns; };
    sensor_.emplace(options, clock,
                    [this](const EmulatedStream& stream) { streams_.push_back(stream); });
    sensor_->update();
  }

  EmulatedAnswer request(const std::string& method, const std::string& target,
                         const std::string& body = {}) {
    return sensor_->answer({method, target, body, "10.0.0.1"});
  }
  json get(const std::string& target) { return json::parse(request("GET", target).body); }
  void wait(std::int64_t duration_ns) {
    fake_now_ns += duration_ns;
    sensor_->update();
  }

  std::optional<EmulatedSensor> sensor_;
  std::vector<EmulatedStream> streams_;
};

TEST_F(EmulatedSensorTest, ReinitialisesForAWhileWithANewInitId) {
  start("v3.1.0");
  const auto init_id = get("/api/v1/sensor/metadata/sensor_info")["initialization_id"];
  EXPECT_EQ(request("POST", "/api/v1/sensor/config", R"({"udp_dest":"@auto"})").status, 200);
  EXPECT_EQ(get("/api/v1/sensor/metadata/sensor_info")["status"], "INITIALIZING");
  EXPECT_FALSE(streams_.back().sending);
  wait(kNsPerSecond);
  const json info = get("/api/v1/sensor/metadata/sensor_info");
  EXPECT_EQ(info["status"], "RUNNING");
  EXPECT_NE(info["initialization_id"], init_id);
  EXPECT_TRUE(streams_.back().sending);
  EXPECT_EQ(streams_.back().destination, "10.0.0.1");
  EXPECT_EQ(streams_.back().init_id, info["initialization_id"]);
}

TEST_F(EmulatedSensorTest, LosesWhatWasNotPersisted) {
  start("v3.1.0");
  request("POST", "/api/v1/sensor/config?persist=true", R"({"lidar_mode":"1024x10"})");
  request("POST", "/api/v1/sensor/config", R"({"lidar_mode":"2048x10"})");
  EXPECT_EQ(get("/api/v1/sensor/config")["lidar_mode"], "2048x10");
  sensor_->power_on();
  EXPECT_EQ(get("/api/v1/sensor/config")["lidar_mode"], "1024x10");
  EXPECT_EQ(sensor_->counts().flash_writes, 1U);
}

TEST_F(EmulatedSensorTest, StagedSettingsWaitForAReinitialise) {
  start("v2.5.0");
  EXPECT_EQ(request("GET", "/api/v1/sensor/cmd/set_config_param?args=lidar_mode+1024x10").body,
            "\"set_config_param\"");
  EXPECT_EQ(get("/api/v1/sensor/cmd/get_config_param?args=active")["lidar_mode"], "512x10");
  EXPECT_EQ(get("/api/v1/sensor/cmd/get_config_param?args=staged")["lidar_mode"], "1024x10");
  EXPECT_EQ(request("GET", "/api/v1/sensor/cmd/reinitialize").body, "{}");
  EXPECT_EQ(get("/api/v1/sensor/cmd/get_config_param?args=active")["lidar_mode"], "1024x10");
}

TEST_F(EmulatedSensorTest, ManySettingsAreSetAtOnceUnderADot) {
  start("v2.5.0");
  request("GET", "/api/v1/sensor/cmd/set_config_param?args=.+%7B%22udp_port_imu%22:7603%7D");
  EXPECT_EQ(get("/api/v1/sensor/cmd/get_config_param?args=staged")["udp_port_imu"], 7603);
}

TEST_F(EmulatedSensorTest, TheDefaultTargetOfFirmware4IsTheFlash) {
  start("v4.0.0");
  request("POST", "/api/v1/sensor/config?target=active", R"({"lidar_mode":"2048x10"})");
  EXPECT_EQ(sensor_->counts().flash_writes, 0U);
  request("POST", "/api/v1/sensor/config", R"({"lidar_mode":"1024x10"})");
  EXPECT_EQ(sensor_->counts().flash_writes, 1U);
}

TEST_F(EmulatedSensorTest, AnswersOnlyInTheFormOfItsFirmware) {
  start("v3.1.0");
  EXPECT_EQ(request("GET", "/api/v1/sensor/cmd/get_config_param?args=active").status, 404);
  start("v2.5.0");
  EXPECT_EQ(request("GET", "/api/v1/sensor/config").status, 404);
  start("v1.13.0");
  EXPECT_EQ(request("GET", "/api/v1/sensor/metadata").status, 404);
}

TEST_F(EmulatedSensorTest, RefusesSettingsItDoesNotHave) {
  start("v3.1.0");
  EXPECT_EQ(request("POST", "/api/v1/sensor/config", R"({"lidar_mode":"9x9"})").status, 400);
  EXPECT_EQ(request("POST", "/api/v1/sensor/config", R"({"udp_port_lidar":99999})").status, 400);
  EXPECT_THAT(request("POST", "/api/v1/sensor/config", R"({"colour":"red"})").body,
              HasSubstr("colour"));
  EXPECT_EQ(sensor_->counts().config_writes, 0U);
}

TEST_F(EmulatedSensorTest, TheTextCommandsKnowTheOldNames) {
  start("v1.13.0");
  EXPECT_EQ(sensor_->answer_line("set_config_param udp_ip 10.0.0.7", ""), "set_config_param");
  EXPECT_EQ(sensor_->answer_line("reinitialize", ""), "reinitialize");
  EXPECT_EQ(streams_.back().destination, "10.0.0.7");
  EXPECT_THAT(sensor_->answer_line("set_config_param udp_dest 10.0.0.7", ""),
              testing::StartsWith("error"));
  EXPECT_THAT(sensor_->answer_line("get_imu_intrinsics", ""), testing::StartsWith("error"));
  EXPECT_THAT(sensor_->answer_line("", ""), testing::StartsWith("error"));
}

// Such bytes cannot stand in a JSON answer that repeats them.
TEST_F(EmulatedSensorTest, BytesThatAreNoTextAreRefused) {
  start("v2.5.0");
  const std::string path = "/api/v1/sensor/cmd/set_config_param?args=";
  EXPECT_EQ(request("GET", path + "udp_port_lidar+7\x99").status, 400);
  EXPECT_EQ(request("GET", path + "%C3%28+7").status, 400);
  EXPECT_THAT(sensor_->answer_line("\xFF", ""), testing::StartsWith("error"));
}

TEST_F(EmulatedSensorTest, ItsMetadataIsReadByTheDriver) {
  start("v3.1.0");
  const SensorInfo info =
      parse_sensor_info(request("GET", "/api/v1/sensor/metadata").body, "emulated");
  EXPECT_EQ(info.serial_number, "122246000293");
  EXPECT_EQ(info.init_id, sensor_->stream().init_id);
}

TEST_F(EmulatedSensorTest, StandbyStopsTheStream) {
  start("v3.1.0");
  EXPECT_TRUE(sensor_->stream().sending);
  request("POST", "/api/v1/sensor/config", R"({"operating_mode":"STANDBY"})");
  wait(kNsPerSecond);
  EXPECT_EQ(sensor_->status(), "STANDBY");
  EXPECT_FALSE(sensor_->stream().sending);
}

TEST_F(EmulatedSensorTest, AnUnknownFirmwareIsRefused) {
  EXPECT_THROW(start("newest"), InputError);
}

}  // namespace
}  // namespace glint::emulator
