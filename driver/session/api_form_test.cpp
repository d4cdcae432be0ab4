// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/api_form.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "driver/core/error.hpp"
#include "driver/session/sensor_address.hpp"

namespace glint {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> names(const std::vector<SensorRequest>& requests) {
  std::vector<std::string> result;
  for (const SensorRequest& request : requests) {
    result.push_back(request.method + (request.method.empty() ? "" : " ") + request.target);
  }
  return result;
}

const nlohmann::json kChanges = {{"azimuth_window", {0, 360000}}, {"lidar_mode", "1024x10"}};

TEST(FirmwareVersionTest, IsFoundInEverySpellingOfSensors) {
  EXPECT_EQ(parse_firmware_version("v2.3.1-rc.1"), (FirmwareVersion{2, 3}));
  EXPECT_EQ(parse_firmware_version("ousteros-image-prod-aries-v1.12.0-20190502211317"),
            (FirmwareVersion{1, 12}));
  EXPECT_EQ(parse_firmware_version("3.10"), (FirmwareVersion{3, 10}));
}

TEST(FirmwareVersionTest, IsNullInJunk) {
  for (const char* junk : {"", "v", "2", "2.", ".3", "99999999999.1", "1.99999999999"}) {
    EXPECT_EQ(parse_firmware_version(junk), std::nullopt) << junk;
  }
}

TEST(ApiFormTest, FollowsTheFirmware) {
  EXPECT_EQ(api_form({1, 12}), ApiForm::kTcp);
  EXPECT_EQ(api_form({2, 0}), ApiForm::kTcp);
  EXPECT_EQ(api_form({2, 1}), ApiForm::kCommandGroups);
  EXPECT_EQ(api_form({3, 0}), ApiForm::kCommands);
  EXPECT_EQ(api_form({3, 1}), ApiForm::kStaging);
  EXPECT_EQ(api_form({4, 0}), ApiForm::kTarget);
}

TEST(ApiFormTest, CommandsSetEachKeyAndThenReinitialise) {
  EXPECT_THAT(
      names(write_requests(ApiForm::kCommands, kChanges, false, "10.0.0.1")),
      ElementsAre("GET /api/v1/sensor/cmd/set_config_param?args=azimuth_window+%5B0%2C360000%5D",
                  "GET /api/v1/sensor/cmd/set_config_param?args=lidar_mode+1024x10",
                  "GET /api/v1/sensor/cmd/reinitialize"));
}

TEST(ApiFormTest, LinesCarryTheSameCommands) {
  EXPECT_THAT(
      names(write_requests(ApiForm::kTcp, kChanges, true, "10.0.0.1")),
      ElementsAre("set_config_param azimuth_window [0,360000]",
                  "set_config_param lidar_mode 1024x10", "reinitialize", "write_config_txt"));
}

TEST(ApiFormTest, AutoIsACommandOverHttpAndThisMachinesAddressInALine) {
  const nlohmann::json changes = {{"udp_dest", "@auto"}};
  EXPECT_EQ(names(write_requests(ApiForm::kCommands, changes, false, "10.0.0.1"))[0],
            "GET /api/v1/sensor/cmd/set_udp_dest_auto");
  EXPECT_EQ(names(write_requests(ApiForm::kTcp, changes, false, "10.0.0.1"))[0],
            "set_config_param udp_dest 10.0.0.1");
}

TEST(ApiFormTest, NothingIsPersistedUnasked) {
  EXPECT_THAT(names(write_requests(ApiForm::kStaging, kChanges, false, "")),
              ElementsAre("POST /api/v1/sensor/config?staging=false&reinit=true&persist=false"));
  EXPECT_THAT(names(write_requests(ApiForm::kTarget, kChanges, false, "")),
              ElementsAre("POST /api/v1/sensor/config?target=active"));
  for (const std::string& name : names(write_requests(ApiForm::kCommands, kChanges, false, ""))) {
    EXPECT_THAT(name, Not(HasSubstr("save")));
  }
}

TEST(SensorAddressTest, TakesNamesAddressesAndPorts) {
  EXPECT_EQ(parse_sensor_address("os-1221.local").host, "os-1221.local");
  EXPECT_EQ(parse_sensor_address("os-1221.local").http_port, 80);
  EXPECT_EQ(parse_sensor_address("127.0.0.1:8080").http_port, 8080);
  EXPECT_EQ(parse_sensor_address("fe80::1%eth0").host, "fe80::1%eth0");
  EXPECT_EQ(parse_sensor_address("[fe80::1%eth0]:81").host, "fe80::1%eth0");
  EXPECT_EQ(parse_sensor_address("[fe80::1%eth0]:81").http_port, 81);
}

TEST(SensorAddressTest, RefusesWhatIsNone) {
  for (const char* junk : {"", ":80", "host:", "host:99999", "host:8o", "http://host", "a b",
                           "[::1", "[::1]80", "host\n"}) {
    EXPECT_THROW(parse_sensor_address(junk), InputError) << junk;
  }
}

}  // namespace
}  // namespace glint
