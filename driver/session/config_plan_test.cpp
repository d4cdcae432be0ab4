// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/config_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glint {
namespace {

using nlohmann::json;
using testing::ElementsAre;

const json kActive = {{"lidar_mode", "1024x10"},
                      {"udp_dest", "10.0.0.1"},
                      {"signal_multiplier", 1},
                      {"udp_port_lidar", 7502}};

TEST(ConfigPlanTest, IsEmptyWhenEverythingIsAsWanted) {
  const json wanted = {{"lidar_mode", "1024x10"}, {"signal_multiplier", 1.0}};
  EXPECT_TRUE(plan_changes(wanted, kActive, "10.0.0.9").changes.empty());
}

TEST(ConfigPlanTest, HoldsOnlyWhatDiffersAndSaysSo) {
  const ConfigPlan plan =
      plan_changes({{"lidar_mode", "512x10"}, {"udp_port_lidar", 7502}}, kActive, "");
  EXPECT_EQ(plan.changes, json({{"lidar_mode", "512x10"}}));
  EXPECT_THAT(plan.lines, ElementsAre("lidar_mode: 1024x10 -> 512x10"));
}

TEST(ConfigPlanTest, AutoIsMetByThisMachinesAddressOnly) {
  const json wanted = {{"udp_dest", "@auto"}};
  EXPECT_TRUE(plan_changes(wanted, kActive, "10.0.0.1").changes.empty());
  EXPECT_EQ(plan_changes(wanted, kActive, "10.0.0.2").changes, wanted);
  EXPECT_EQ(plan_changes(wanted, {{"udp_dest", ""}}, "").changes, wanted);
}

TEST(ConfigPlanTest, SpeaksTheOldNamesToOldSensors) {
  const json wanted = {{"udp_dest", "10.0.0.1"}, {"operating_mode", "NORMAL"}};
  const json old = {{"udp_ip", "10.0.0.2"}, {"auto_start_flag", 0}};
  EXPECT_EQ(plan_changes(wanted, old, "").changes,
            json({{"udp_ip", "10.0.0.1"}, {"auto_start_flag", 1}}));
}

}  // namespace
}  // namespace glint
