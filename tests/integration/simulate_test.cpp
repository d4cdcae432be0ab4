// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// `glint simulate` as users call it: what it writes can be read back, what cannot be done is said.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pcap/test_capture.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_glint;
using ::testing::HasSubstr;

class SimulateCommandTest : public ::testing::Test {
 protected:
  /// A short run of a small sensor; `more` is appended.
  CommandResult simulate(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"simulate", "--seconds", "1", "--columns", "512",
                                          "--beams", "16", "--out", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_glint(arguments);
  }
  nlohmann::json info() const {
    return nlohmann::json::parse(run_glint({"info", out_ / "capture.pcap"}).out);
  }
  void expect_usage(const CommandResult& result, const std::string& named) const {
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_THAT(result.out, HasSubstr(named));
    EXPECT_FALSE(fs::exists(out_ / "capture.pcap"));
  }

  const test::TempDir dir_;
  const fs::path out_ = dir_ / "out";
};

TEST_F(SimulateCommandTest, WhatTheNetworkDoesIsSaidAndSeenInTheCapture) {
  const CommandResult result = simulate({"--world", "room", "--loss", "0.1", "--duplicates", "0.1",
                                         "--reordering", "0.1", "--mtu", "1500"});
  ASSERT_EQ(result.exit_code, 0) << result.out;
  int sent = 0;
  int lost = 0;
  int twice = 0;
  const std::string said = result.out.substr(result.out.find("of "));
  ASSERT_EQ(std::sscanf(said.c_str(), "of %d datagrams %d were lost, %d arrived twice", &sent,
                        &lost, &twice),
            3)
      << result.out;
  EXPECT_GT(lost, 0);
  const CommandResult replay = run_glint({"replay", out_ / "capture.pcap", "--out", dir_ / "run"});
  ASSERT_EQ(replay.exit_code, 0) << replay.out;
  const auto summary = nlohmann::json::parse(std::ifstream(dir_ / "run" / "summary.json"));
  const auto& packets = summary.at("packets");
  const int arrived = packets.at("accepted").get<int>() + packets.at("duplicate").get<int>() +
                      packets.at("late").get<int>() + packets.at("imu").get<int>();
  EXPECT_EQ(arrived, sent - lost + twice);
  EXPECT_EQ(packets.at("bad"), 0);
}

TEST_F(SimulateCommandTest, ImuPacketsOfTheNewProfileAreKnownByTheirSize) {
  ASSERT_EQ(simulate({"--world", "room", "--imu-profile", "ACCEL32_GYRO32_NMEA"}).exit_code, 0);
  const CommandResult replay = run_glint({"replay", out_ / "capture.pcap", "--out", dir_ / "run"});
  ASSERT_EQ(replay.exit_code, 0) << replay.out;
  const auto summary = nlohmann::json::parse(std::ifstream(dir_ / "run" / "summary.json"));
  EXPECT_GE(summary.at("packets").at("imu"), 9);
  EXPECT_EQ(summary.at("packets").at("bad"), 0);
}

TEST_F(SimulateCommandTest, ATrajectoryFileIsFollowedForAsLongAsItLasts) {
  std::ofstream file(dir_ / "way.tum");
  for (int i = 0; i <= 20; ++i) file << 0.1 * i << " " << 3.0 + 0.1 * i << " 4 1.2 0 0 0 1\n";
  file.close();
  const CommandResult result =
      run_glint({"simulate", "--world", "room", "--columns", "512", "--beams", "16", "--out", out_,
                 "--trajectory", dir_ / "way.tum"});
  ASSERT_EQ(result.exit_code, 0) << result.out;
  std::ifstream truth(out_ / "groundtruth.tum");
  std::string line;
  double x_m = 0.0;
  int scans = 0;
  for (; std::getline(truth, line); ++scans) {
    double t = 0.0;
    std::istringstream(line) >> t >> x_m;
    EXPECT_NEAR(x_m, 3.0 + 0.1 * scans, 0.002);
  }
  EXPECT_EQ(scans, 20);
}

TEST_F(SimulateCommandTest, WrongOptionsAreNamedWithWhatIsPossible) {
  expect_usage(simulate({"--world", "moon"}), "choose one of corridor");
  expect_usage(simulate({"--world", "room", "--motion", "flying"}), "walking");
  expect_usage(simulate({"--world", "room", "--profile", "RNG99"}), "RNG15_RFL8_NIR8");
  expect_usage(simulate({"--world", "room", "--loss", "1.5"}), "loss");
  expect_usage(simulate({"--world", "room", "--seed", "one"}), "--seed = \"one\"");
  expect_usage(simulate({"--world", "room", "--rate", "15"}), "choose one of 10, 20");
  expect_usage(simulate({"--world", "room", "--to", "127.0.0.1:7502"}), "either --out");
}

TEST_F(SimulateCommandTest, FilesThatCannotBeUsedAreNamed) {
  const CommandResult missing = simulate({"--world", "room", "--trajectory", "/none.tum"});
  EXPECT_EQ(missing.exit_code, 3) << missing.out;
  EXPECT_THAT(missing.out, HasSubstr("/none.tum"));
  std::ofstream(dir_ / "picture.pgm") << "P5 10 10 255\nshort";
  const CommandResult cut = simulate({"--world", "room", "--photograph", dir_ / "picture.pgm"});
  EXPECT_EQ(cut.exit_code, 3) << cut.out;
  EXPECT_THAT(cut.out, HasSubstr("picture.pgm"));
  EXPECT_FALSE(fs::exists(out_ / "capture.pcap"));
}

}  // namespace
}  // namespace glint
