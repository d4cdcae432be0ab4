// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// glint export, glint maps: on a session as a user has it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "pcap/test_capture.hpp"
#include "slam/store/session_store.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint::test {
namespace {

constexpr std::uint64_t kKeyframes = 5;

class ExportCommand : public testing::Test {
 protected:
  ExportCommand() {
    slam::SessionStore store(session_);
    for (std::uint64_t id = 0; id < kKeyframes; ++id) {
      slam::Keyframe keyframe;
      keyframe.id = id;
      keyframe.estimate.stamp.ns = static_cast<std::int64_t>(1 + id) * kNsPerSecond;
      for (int i = 0; i < 360; ++i) {
        const auto angle = static_cast<float>(i) * 0.01745F;
        keyframe.points.push_back({3.0F * std::cos(angle), 3.0F * std::sin(angle), 0.2F, 50.0F});
      }
      store.add(keyframe, {Eigen::Quaterniond::Identity(), {static_cast<double>(id), 0.0, 0.0}});
    }
  }

  [[nodiscard]] CommandResult run_export(const std::string& format) const {
    return run_glint({"export", session_.string(), "--format", format, "--out",
                      (dir_ / ("map." + format)).string()});
  }

  const TempDir dir_;
  const std::filesystem::path session_ = dir_ / "session.glint";
};

TEST_F(ExportCommand, EveryFormatIsWritten) {
  for (const char* format : {"ply", "pcd", "las", "tum", "kitti", "pgm"}) {
    const CommandResult result = run_export(format);
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_GT(std::filesystem::file_size(dir_ / (std::string("map.") + format)), 100U) << format;
  }
  EXPECT_TRUE(std::filesystem::exists(dir_ / "map.yaml"));
  EXPECT_TRUE(std::filesystem::exists(dir_ / "map.times.txt"));
  EXPECT_FALSE(std::filesystem::exists(dir_ / "session.glint-wal"));
}

TEST_F(ExportCommand, TrajectoriesHaveALineAKeyframe) {
  ASSERT_EQ(run_export("tum").exit_code, 0);
  std::ifstream in(dir_ / "map.tum");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), kKeyframes);
  EXPECT_EQ(lines[2], "3.000000000 2 0 0 0 0 0 1");
}

TEST_F(ExportCommand, WhatIsNoSessionIsBadInput) {
  std::ofstream(session_) << "no session";
  const CommandResult result = run_export("ply");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.out.find("is no Glint session"), std::string::npos) << result.out;
  EXPECT_EQ(run_glint({"export", session_.string(), "--format", "dxf", "--out", "x"}).exit_code, 2);
}

TEST_F(ExportCommand, SessionsAreListed) {
  std::ofstream(dir_ / "broken.glint") << "no session";
  const CommandResult result = run_glint({"maps", session_.parent_path().string(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const auto sessions = nlohmann::json::parse(result.out);
  ASSERT_EQ(sessions.size(), 2U);
  EXPECT_TRUE(sessions[0].contains("error"));
  EXPECT_EQ(sessions[1]["keyframes"], kKeyframes);
  EXPECT_EQ(sessions[1]["way_m"], 4.0);
  EXPECT_EQ(run_glint({"maps", (dir_ / "none").string()}).exit_code, 3);
}

}  // namespace
}  // namespace glint::test
