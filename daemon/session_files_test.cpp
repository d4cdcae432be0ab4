// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session_files.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "slam/store/test_session.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class SessionFilesTest : public slam::test::InDirectory {
 protected:
  SessionFilesTest() { fs::create_directories(directory_ / "maps"); }

  /// A file of so many bytes that was written so long ago.
  fs::path make(const std::string& name, std::size_t bytes, std::chrono::hours age) const {
    const fs::path file = directory_ / name;
    std::ofstream(file) << std::string(bytes, 'x');
    fs::last_write_time(file, fs::file_time_type::clock::now() - age);
    return file;
  }
  [[nodiscard]] std::vector<std::string> removed(std::uint64_t most_bytes,
                                                 const fs::path& current) const {
    std::vector<std::string> names;
    for (const RemovedSession& session : remove_old_sessions(directory_, most_bytes, current)) {
      EXPECT_FALSE(fs::exists(session.file));
      names.push_back(session.file.filename());
    }
    return names;
  }
};

using Names = std::vector<std::string>;

TEST_F(SessionFilesTest, TheOldestGoUntilTheRestFits) {
  make("session-20260101T000000Z.glint", 400, 30h);
  make("session-20260102T000000Z.glint", 400, 20h);
  make("session-20260103T000000Z.glint", 400, 10h);
  const fs::path current = make("session-20260104T000000Z.glint", 100, 0h);
  EXPECT_EQ(removed(1300, current), Names{});
  EXPECT_EQ(removed(1299, current), Names{"session-20260101T000000Z.glint"});
  EXPECT_EQ(removed(600, current), Names{"session-20260102T000000Z.glint"});
}

TEST_F(SessionFilesTest, OldestIsTheOneNotWrittenToForLongest) {
  make("session-20260101T000000Z.glint", 400, 1h);
  make("session-20260102T000000Z.glint", 400, 9h);
  EXPECT_EQ(removed(500, {}), Names{"session-20260102T000000Z.glint"});
}

TEST_F(SessionFilesTest, WhatIsWrittenNowStaysWhateverItsSizeAndAge) {
  const fs::path current = make("session-20260101T000000Z.glint", 5000, 30h);
  make("session-20260102T000000Z.glint", 10, 20h);
  EXPECT_EQ(removed(100, current), Names{"session-20260102T000000Z.glint"});
  EXPECT_TRUE(fs::exists(current));
}

TEST_F(SessionFilesTest, TheLogCountsAndGoesWithItsSession) {
  make("session-20260101T000000Z.glint", 10, 30h);
  make("session-20260101T000000Z.glint-wal", 1000, 30h);
  make("session-20260101T000000Z.glint-shm", 10, 30h);
  make("session-20260102T000000Z.glint", 10, 20h);
  EXPECT_EQ(removed(500, {}), Names{"session-20260101T000000Z.glint"});
  EXPECT_FALSE(fs::exists(directory_ / "session-20260101T000000Z.glint-wal"));
  EXPECT_FALSE(fs::exists(directory_ / "session-20260101T000000Z.glint-shm"));
}

TEST_F(SessionFilesTest, SavedMapsAndFilesOfOthersAreNeverTouched) {
  const Names others = {"maps/session-20250101T000000Z.glint", "maps/office.glint", "mine.glint",
                        "session-notes.txt"};
  for (const std::string& name : others) make(name, 1000, 1000h);
  make("session-20260101T000000Z.glint", 10, 1h);
  EXPECT_EQ(removed(1, {}), Names{"session-20260101T000000Z.glint"});
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(directory_ / name)) << name;
}

TEST_F(SessionFilesTest, ADamagedSessionIsDescribedByItsDamage) {
  const Json told = describe_session(make("broken.glint", 100, 0h));
  EXPECT_EQ(told.size(), 1U);
  EXPECT_NE(told["error"].get<std::string>().find("broken.glint"), std::string::npos) << told;
}

}  // namespace
}  // namespace glint::daemon
