// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/scenario.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "driver/core/error.hpp"
#include "driver/core/time.hpp"
#include "driver/emulator/scenario_player.hpp"
#include "driver/emulator/test_metadata.hpp"

namespace glint::emulator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string complaint(const std::string& text) {
  try {
    parse_scenario(text, "drive.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string event(const std::string& lines) { return "[[event]]\n" + lines + "\n"; }

TEST(ScenarioTest, IsReadInTheOrderOfTime) {
  const Scenario scenario =
      parse_scenario(event("at_s = 60\nevery_s = 60\naction = 'restart'") +
                         event("at_s = 0.5\naction = 'loss'\nshare = 0.05") +
                         event("at_s = 70\naction = 'clock_jump'\nseconds = -3.0"),
                     "drive.toml");
  ASSERT_EQ(scenario.size(), 3U);
  EXPECT_EQ(scenario[0].action, ScenarioAction::kLoss);
  EXPECT_EQ(scenario[0].at_ns, kNsPerSecond / 2);
  EXPECT_DOUBLE_EQ(scenario[0].value, 0.05);
  EXPECT_EQ(scenario[1].every_ns, 60 * kNsPerSecond);
  EXPECT_DOUBLE_EQ(scenario[2].value, -3.0);
}

TEST(ScenarioTest, MistakesAreNamedWithFileLineAndWayOut) {
  EXPECT_THAT(complaint(event("at_s = 1\naction = 'los'")),
              testing::AllOf(HasSubstr("drive.toml:3: action cannot be \"los\""),
                             HasSubstr("loss, reordering")));
  EXPECT_THAT(complaint(event("action = 'restart'")), HasSubstr("at_s must be a number"));
  EXPECT_THAT(complaint(event("at_s = 1\naction = 'loss'\nshare = 5")),
              HasSubstr("drive.toml:4: share must be a number from 0 to 0.999"));
  EXPECT_THAT(complaint(event("at_s = 1\naction = 'loss'\nshare = nan")), HasSubstr("share"));
  EXPECT_THAT(complaint(event("at_s = 1\naction = 'loss'\nseconds = 1\nshare = 0.1")),
              HasSubstr("seconds is no key of the action loss; remove it, or write share"));
  EXPECT_THAT(complaint(event("at_s = 1\naction = 'foreign_packets'\ncount = 1.5")),
              HasSubstr("whole number"));
  EXPECT_THAT(complaint("at_s = ["), HasSubstr("drive.toml:1:"));
  EXPECT_THAT(complaint(""), HasSubstr("[[event]]"));
  EXPECT_THAT(complaint("event = [1]"), HasSubstr("[[event]]"));
  EXPECT_THROW(load_scenario("/nowhere/drive.toml"), InputError);
}

struct RecordingSink : PacketFaultSink {
  void set_faults(const PacketFaults& faults) override { shares.push_back(faults.loss); }
  void send_foreign(std::uint64_t count) override { foreign += count; }
  std::vector<double> shares;
  std::uint64_t foreign = 0;
};

TEST(ScenarioTest, HappensWhenItsTimeHasComeAndRepeats) {
  boost::asio::io_context io;
  SensorEmulatorOptions options;
  options.sensor.metadata_json = test::metadata();
  EmulatedStream stream;
  SensorEmulator emulator(io, options, {}, [&](const EmulatedStream& now) { stream = now; });
  RecordingSink sink;
  ScenarioPlayer player(
      parse_scenario(event("at_s = 1\nevery_s = 2\naction = 'restart'") +
                         event("at_s = 2\naction = 'loss'\nshare = 0.5") +
                         event("at_s = 2\naction = 'foreign_packets'\ncount = 9") +
                         event("at_s = 4\naction = 'loss'\nshare = 0.0") +
                         event("at_s = 4\naction = 'clock_jump'\nseconds = 3"),
                     "drive.toml"),
      emulator, sink);
  EXPECT_EQ(player.play(0), kNsPerSecond);
  EXPECT_EQ(player.play(kNsPerSecond), 2 * kNsPerSecond);
  EXPECT_EQ(emulator.sensor().counts().starts, 1U);
  EXPECT_EQ(player.play(4 * kNsPerSecond), 5 * kNsPerSecond);
  EXPECT_EQ(emulator.sensor().counts().starts, 2U);
  EXPECT_THAT(sink.shares, ElementsAre(0.5, 0.0));
  EXPECT_EQ(sink.foreign, 9U);
  EXPECT_EQ(stream.clock_offset_ns, 3 * kNsPerSecond);
}

TEST(ScenarioTest, TheShippedExampleIsRead) {
  const Scenario scenario = load_scenario(GLINT_SOURCE_DIR "/config/bad-day.scenario.toml");
  EXPECT_GE(scenario.size(), 10U);
}

}  // namespace
}  // namespace glint::emulator
