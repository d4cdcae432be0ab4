// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session_plan.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class SessionPlanTest : public slam::test::InDirectory {
 protected:
  SessionPlanTest() {
    config_.state.directory = directory_.string();
    config_.map.on_start = "continue";
  }

  /// A session with so many keyframes that was written to so long ago.
  fs::path make(const std::string& name, std::uint64_t keyframes, std::chrono::hours age) const {
    const fs::path file = directory_ / name;
    {
      slam::SessionStore store(file);
      for (std::uint64_t id = 0; id < keyframes; ++id) {
        store.add(slam::test::sample_keyframe(id), slam::test::sample_map_pose(id));
      }
    }
    fs::last_write_time(file, fs::file_time_type::clock::now() - age);
    return file;
  }

  Config config_;
};

TEST_F(SessionPlanTest, ANewMapGetsAFileOfItsOwn) {
  make("session-20260101T000000Z.glint", 2, 1h);
  config_.map.on_start = "new";
  const SessionPlan plan = plan_session(config_);
  EXPECT_FALSE(fs::exists(plan.file));
  EXPECT_EQ(plan.file.parent_path(), directory_);
  EXPECT_EQ(plan.earlier, "");
}

TEST_F(SessionPlanTest, TheSessionWrittenToLastIsGoneOnWith) {
  const fs::path latest = make("session-20260101T000000Z.glint", 2, 1h);
  make("session-20260102T000000Z.glint", 2, 2h);
  const SessionPlan plan = plan_session(config_);
  EXPECT_EQ(plan.file, latest);
  EXPECT_EQ(plan.earlier, latest);
  EXPECT_FALSE(fs::exists(plan.otherwise));
  EXPECT_NE(plan.otherwise, "");
}

TEST_F(SessionPlanTest, EmptyAndDamagedSessionsAndMapsOfOtherNamesArePassedOver) {
  const fs::path good = make("session-20260101T000000Z.glint", 2, 9h);
  make("session-20260102T000000Z.glint", 0, 3h);
  const fs::path damaged = directory_ / "session-20260103T000000Z.glint";
  slam::test::write_bytes(damaged, "no session at all");
  make("mine.glint", 2, 0h);
  EXPECT_EQ(plan_session(config_).earlier, good);
  EXPECT_EQ(slam::test::read_bytes(damaged), "no session at all") << "it is left as it is";
}

TEST_F(SessionPlanTest, AMapToLocaliseInIsTheSavedOneOfThatNameAndNothingIsKept) {
  fs::create_directories(directory_ / "maps");
  make("maps/office.glint", 2, 1h);
  config_.map.on_start = "localize:office";
  const SessionPlan plan = plan_session(config_);
  EXPECT_EQ(plan.earlier, directory_ / "maps" / "office.glint");
  EXPECT_EQ(plan.file, "");
  EXPECT_EQ(plan.otherwise, "");
  EXPECT_EQ(plan.use, slam::MapUse::kLocalize);
  config_.map.on_start = "localize:attic";
  EXPECT_THROW(plan_session(config_), ConfigError);
  config_.state.directory = "";
  EXPECT_THROW(plan_session(config_), ConfigError);
}

TEST_F(SessionPlanTest, WithoutAnySessionOrPlaceForOneAMapIsBegun) {
  EXPECT_EQ(plan_session(config_).earlier, "");
  EXPECT_NE(plan_session(config_).file, "");
  config_.state.directory = "";
  EXPECT_EQ(plan_session(config_).earlier, "");
  EXPECT_EQ(plan_session(config_).file, "");
}

}  // namespace
}  // namespace glint::daemon
