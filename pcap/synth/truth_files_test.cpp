// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/truth_files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "driver/core/sensor_info.hpp"
#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

namespace fs = std::filesystem;

class SimulateTest : public testing::Test {
 protected:
  SimulateTest() {
    options_.world = "room";
    options_.seconds = 0.3;
    options_.sensor = {.beams = 32, .columns = 512, .profile = LidarProfile::kLegacy};
  }
  ~SimulateTest() override { fs::remove_all(directory_); }

  static std::vector<nlohmann::json> lines_of(const fs::path& file) {
    std::ifstream in(file);
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
  }

  const fs::path directory_ =
      fs::temp_directory_path() / ("glint-simulate-" + std::to_string(getpid()));
  SimulationOptions options_;
};

TEST_F(SimulateTest, LeavesCaptureMetadataAndTruth) {
  simulate(options_, directory_);
  for (const char* name : {"capture.pcap", "metadata.json", "groundtruth.tum",
                           "groundtruth_100hz.tum", "truth.jsonl"}) {
    EXPECT_GT(fs::file_size(directory_ / name), 0U) << name;
  }
  const SensorInfo info = load_sensor_info(directory_ / "metadata.json");
  EXPECT_EQ(info.profile, LidarProfile::kLegacy);
  EXPECT_EQ(info.pixels_per_column, 32);
  const auto lines = lines_of(directory_ / "truth.jsonl");
  ASSERT_EQ(lines.size(), 3U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].at("frame_id"), i + 1);
    EXPECT_TRUE(lines[i].at("blind_axes").empty());
    EXPECT_TRUE(lines[i].at("moving_pixels").empty());
    EXPECT_TRUE(lines[i].at("earlier_scans_within_2m").empty());
  }
}

TEST_F(SimulateTest, PlacesSeenBeforeAreNamed) {
  options_.seconds = 40.0;  // More than once round the room.
  options_.sensor.beams = 16;
  simulate(options_, directory_);
  const auto lines = lines_of(directory_ / "truth.jsonl");
  ASSERT_EQ(lines.size(), 400U);
  std::vector<Eigen::Vector3d> at_m;
  std::ifstream poses(directory_ / "groundtruth.tum");
  for (std::string line; std::getline(poses, line);) {
    double t = 0;
    Eigen::Vector3d p;
    std::istringstream(line) >> t >> p.x() >> p.y() >> p.z();
    at_m.push_back(p);
  }
  int revisits = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const auto& run : lines[i].at("earlier_scans_within_2m")) {
      for (std::size_t j = run[0]; j <= run[1]; ++j) {
        ++revisits;
        ASSERT_LT((at_m[i] - at_m[j]).norm(), 2.0);
        ASSERT_LT(j + 50, i);  // 10 m of way take five seconds and more.
      }
    }
  }
  EXPECT_GT(revisits, 1000);
}

TEST_F(SimulateTest, ADirectoryThatCannotBeMadeIsNamed) {
  try {
    simulate(options_, "/proc/none/here");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/none/here"), std::string::npos);
  }
}

// A limit on the size of files fails writes as a full disk does.
TEST_F(SimulateTest, AFullDiskLeavesNothingThatLooksWhole) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{200'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  std::string said;
  try {
    simulate(options_, directory_);
  } catch (const InputError& error) {
    said = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(said.find("capture.pcap"), std::string::npos) << said;
  EXPECT_TRUE(fs::is_empty(directory_));
}

}  // namespace
}  // namespace glint::synth
