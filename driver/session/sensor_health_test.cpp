// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/sensor_health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "driver/session/sensor_json.hpp"

namespace glint {
namespace {

using nlohmann::json;

json ptp(const char* state, const char* grandmaster) {
  return {{"port_data_set", {{"port_state", state}, {"port_identity", "bc0fa7.fffe.c48254-1"}}},
          {"parent_data_set", {{"grandmaster_identity", grandmaster}}},
          {"current_data_set", {{"offset_from_master", -211.5}}},
          {"time_properties_data_set", {{"current_utc_offset", 37}}}};
}

TEST(SensorHealthTest, PtpIsLockedOnlyToAClockThatIsNotItsOwn) {
  const PtpState good = parse_ptp(ptp("SLAVE", "001747.fffe.700038"));
  EXPECT_TRUE(good.locked);
  EXPECT_EQ(good.offset_ns, -211.5);
  EXPECT_EQ(good.utc_offset_s, 37);
  EXPECT_FALSE(parse_ptp(ptp("SLAVE", "bc0fa7.fffe.c48254")).locked);
  EXPECT_FALSE(parse_ptp(ptp("LISTENING", "001747.fffe.700038")).locked);
}

TEST(SensorHealthTest, AlertsTellOfHeatAndOfLessLaserPower) {
  SensorHealth health;
  take_alerts(health, parse_alerts({{"active", {{{"category", "SHOT_LIMITING"}, {"id", "0x1"}}}}}));
  EXPECT_TRUE(health.shot_limiting);
  EXPECT_FALSE(health.overheating);
  take_alerts(health, parse_alerts({{"active", {{{"category", "OVERTEMP"}}}}}));
  EXPECT_FALSE(health.shot_limiting);
  EXPECT_TRUE(health.overheating);
}

TEST(SensorHealthTest, AnythingElseThanExpectedStaysEmpty) {
  for (const char* odd :
       {"null", "[]", "3", "\"x\"", R"({"active":3})", R"({"active":[3,[]]})",
        R"({"port_data_set":[],"current_data_set":{"offset_from_master":"x"}})"}) {
    const json value = json::parse(odd);
    EXPECT_TRUE(parse_alerts(value).empty()) << odd;
    EXPECT_FALSE(parse_ptp(value).locked) << odd;
    EXPECT_EQ(parse_telemetry(value).temperature_degc, std::nullopt) << odd;
    EXPECT_EQ(parse_time(value).time_s, std::nullopt) << odd;
  }
}

TEST(SensorHealthTest, AnEndlessListOfAlertsIsCut) {
  json value = {{"active", json::array()}};
  for (int i = 0; i < 1000; ++i) value["active"].push_back({{"id", "0x1"}});
  EXPECT_EQ(parse_alerts(value).size(), 64U);
}

TEST(SensorJsonTest, IsBoundedInDepthAndSize) {
  EXPECT_TRUE(parse_sensor_json(std::string(16, '[') + std::string(16, ']')));
  EXPECT_FALSE(parse_sensor_json(std::string(17, '[') + std::string(17, ']')));
  EXPECT_FALSE(parse_sensor_json(std::string(500'000, '[')));
  EXPECT_FALSE(parse_sensor_json('"' + std::string(kMaxReplyBytes, 'x') + '"'));
}

TEST(SensorJsonTest, ExcerptsHoldNothingThatATerminalObeys) {
  EXPECT_EQ(excerpt("a\x1b[31mb\nc\xff", 100), "a [31mb c ");
  EXPECT_EQ(excerpt("abcdef", 3), "abc...");
}

}  // namespace
}  // namespace glint
