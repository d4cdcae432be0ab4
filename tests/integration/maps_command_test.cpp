// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint save, glint maps --connect, glint delete-map: on a daemon that maps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/test_daemon.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/test_session.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_glint;
using testing::HasSubstr;
using testing::Not;

class MapsCommand : public slam::test::InDirectory {
 protected:
  MapsCommand() {
    Config config;
    config.state.directory = directory_.string();
    RuntimeOptions options;
    options.session.file = directory_ / "session-now.glint";
    daemon_.emplace(config, options);
    daemon_->feed(test::room_packets(daemon_->info(), 3));
    EXPECT_TRUE(daemon_->wait_for("get_status", [](const Json& s) {
      return test::has_poses(s, 3) && s["map"]["keyframes"] > 0;
    }));
  }

  /// `glint` with the daemon's address.
  [[nodiscard]] CommandResult glint(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--connect", daemon_->address()});
    return run_glint(arguments);
  }

  std::atomic<bool> stop_{false};  ///< For a job, which may outlive its test's function.
  std::optional<test::TestDaemon> daemon_;
};

TEST_F(MapsCommand, TheTrajectoryComesAsAFile) {
  const fs::path file = directory_ / "way.tum";
  const CommandResult fetched = glint({"trajectory", "--frame", "odom", "--out", file.string()});
  ASSERT_EQ(fetched.exit_code, 0) << fetched.out;
  std::ifstream lines(file);
  std::string line;
  std::vector<std::string> all;
  while (std::getline(lines, line)) all.push_back(line);
  ASSERT_GE(all.size(), 3U);
  EXPECT_EQ(std::ranges::count(all.front(), ' '), 7) << all.front();
  EXPECT_EQ(Json::parse(glint({"trajectory", "--out", file.string(), "--json"}).out)["frame"],
            "map");
}

TEST_F(MapsCommand, PauseAndResumeAndWaiting) {
  const CommandResult placed = glint({"wait", "--timeout", "10", "--json"});
  ASSERT_EQ(placed.exit_code, 0) << placed.out;
  EXPECT_TRUE(Json::parse(placed.out).contains("p_m"));
  ASSERT_EQ(glint({"pause"}).exit_code, 0);
  EXPECT_TRUE(
      daemon_->wait_for("get_status", [](const Json& s) { return s["state"] == "PAUSED"; }));
  const CommandResult late = glint({"wait", "--timeout", "0.5"});
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_THAT(late.out, HasSubstr("its state is PAUSED"));
  ASSERT_EQ(glint({"resume"}).exit_code, 0);
  EXPECT_TRUE(
      daemon_->wait_for("get_status", [](const Json& s) { return s["state"] != "PAUSED"; }));
  EXPECT_EQ(glint({"reset"}).exit_code, 0);
  ASSERT_EQ(glint({"clear"}).exit_code, 0);
  EXPECT_TRUE(
      daemon_->wait_for("get_status", [](const Json& s) { return s["map"]["keyframes"] == 0; }));
}

TEST_F(MapsCommand, WhoWaitsForADaemonThatIsNotThereIsToldSo) {
  const CommandResult alone = run_glint({"wait", "--timeout", "0.5", "--connect", "127.0.0.1:1"});
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_THAT(alone.out, HasSubstr("127.0.0.1:1"));
}

TEST_F(MapsCommand, AMapIsSavedListedAndDeleted) {
  EXPECT_THAT(glint({"maps"}).out, HasSubstr("no maps"));
  const CommandResult saved = glint({"save", "office"});
  ASSERT_EQ(saved.exit_code, 0) << saved.out;
  EXPECT_THAT(saved.out, HasSubstr("office: "));
  EXPECT_THAT(saved.out, HasSubstr("checksum "));
  EXPECT_THAT(saved.out, Not(HasSubstr("%"))) << "no progress in a pipe";
  EXPECT_GT(slam::SessionReader(directory_ / "maps" / "office.glint").keyframe_count(), 0U);

  const CommandResult listed = glint({"maps"});
  EXPECT_EQ(listed.exit_code, 0);
  EXPECT_THAT(listed.out, HasSubstr("office: 1 keyframes in 1 segments"));
  EXPECT_EQ(Json::parse(glint({"maps", "--json"}).out)["maps"][0]["name"], "office");

  EXPECT_EQ(glint({"delete-map", "office"}).exit_code, 0);
  const CommandResult again = glint({"delete-map", "office"});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.out, HasSubstr("no map 'office'"));
}

TEST_F(MapsCommand, JsonIsTheJobAsItEnded) {
  const CommandResult saved = glint({"save", "office", "--json"});
  ASSERT_EQ(saved.exit_code, 0) << saved.out;
  const Json job = Json::parse(saved.out);
  EXPECT_EQ(job["state"], "done");
  EXPECT_EQ(job["result"]["name"], "office");
  EXPECT_EQ(job["result"]["checksum"].get<std::string>().size(), 16U);
}

TEST_F(MapsCommand, TheDirectorysSessionsAreStillListed) {
  ASSERT_EQ(glint({"save", "office"}).exit_code, 0);
  const CommandResult listed = run_glint({"maps", (directory_ / "maps").string(), "--json"});
  ASSERT_EQ(listed.exit_code, 0) << listed.out;
  EXPECT_EQ(Json::parse(listed.out)[0]["keyframes"], 1);
  EXPECT_EQ(glint({"maps", directory_.string()}).exit_code, 2) << "one or the other";
}

TEST_F(MapsCommand, ExitCodesTellBadNamesFailuresAndAnAbsentDaemonApart) {
  EXPECT_EQ(glint({"save", "../office"}).exit_code, 2);
  EXPECT_EQ(glint({"save"}).exit_code, 2);
  EXPECT_EQ(glint({"delete-map", "a/b"}).exit_code, 2);
  for (const char* command : {"save", "delete-map"}) {
    EXPECT_EQ(run_glint({command, "a", "--connect", "127.0.0.1:1"}).exit_code, 4) << command;
  }
  EXPECT_EQ(run_glint({"maps", "--connect", "127.0.0.1:1"}).exit_code, 4);

  ASSERT_TRUE(daemon_->runtime().start_job("walk", [this](RunningJob&) {
    while (!stop_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return std::optional<Json>(Json::object());
  }));
  const CommandResult busy = glint({"save", "office"});
  stop_ = true;
  EXPECT_EQ(busy.exit_code, 1);
  EXPECT_THAT(busy.out, HasSubstr("(walk) is running"));
}

TEST_F(MapsCommand, AJobThatFailsIsToldWithItsReason) {
  fs::create_directories(directory_ / "maps" / "office.glint" / "in the way");
  const CommandResult saved = glint({"save", "office"});
  EXPECT_EQ(saved.exit_code, 1) << saved.out;
  EXPECT_THAT(saved.out, HasSubstr("the map office was not saved: cannot write"));
}

}  // namespace
}  // namespace glint::daemon
