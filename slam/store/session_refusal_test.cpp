// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <random>

#include "slam/store/session_copy.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

class SessionRefusal : public test::InDirectory {
 protected:
  void write() const {
    SessionStore store(file_);
    for (std::uint64_t id = 0; id < 20; ++id) store.add(test::sample_keyframe(id), {});
  }
  void run(const char* sql) const {
    sqlite3* db = nullptr;
    sqlite3_open(file_.c_str(), &db);
    EXPECT_EQ(sqlite3_exec(db, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(db);
  }
  // What reading and continuing it say, which is the same; the file stays as it is.
  [[nodiscard]] std::string refusal() const {
    const std::string bytes = test::read_bytes(file_);
    const std::string names = files();
    std::string said = test::refusal_of([&] { const SessionReader reader(file_); });
    EXPECT_EQ(test::refusal_of([&] { const SessionStore store(file_, {.continues = true}); }),
              said);
    EXPECT_EQ(test::read_bytes(file_), bytes);
    EXPECT_EQ(files(), names);
    EXPECT_NE(said.find(file_.string()), std::string::npos) << said;
    return said;
  }
};

TEST_F(SessionRefusal, ANewerVersionAsksForAnUpdate) {
  write();
  run("PRAGMA user_version = 3");
  EXPECT_NE(refusal().find("newer Glint (its format is 3, this one reads up to 2); update"),
            std::string::npos);
}

TEST_F(SessionRefusal, AnotherProgramsDatabaseIsNoSession) {
  run("PRAGMA application_id = 7; CREATE TABLE keyframes (id); PRAGMA user_version = 2;");
  EXPECT_NE(refusal().find("another program's database"), std::string::npos);
}

TEST_F(SessionRefusal, OtherFilesAreNoSession) {
  test::write_bytes(file_, std::string(5000, 'x'));
  EXPECT_NE(refusal().find("not an SQLite database"), std::string::npos);
}

TEST_F(SessionRefusal, AnEmptyFileIsNoSession) {
  test::write_bytes(file_, "");
  EXPECT_NE(refusal().find("is no Glint session, but empty"), std::string::npos);
}

TEST_F(SessionRefusal, WhatIsNotThereIsNamed) {
  const std::string said = test::refusal_of([&] { const SessionReader reader(file_); });
  EXPECT_NE(said.find("there is no session file " + file_.string()), std::string::npos) << said;
  EXPECT_NE(test::refusal_of([&] { const SessionReader reader(directory_); }), "");
}

TEST_F(SessionRefusal, ATruncatedFileIsDamagedWhereverItEnds) {
  write();
  const std::string bytes = test::read_bytes(file_);
  for (const std::size_t size : {bytes.size() - 1, bytes.size() - 4096, bytes.size() / 2,
                                 std::size_t{4096}, std::size_t{200}}) {
    test::write_bytes(file_, bytes.substr(0, size));
    EXPECT_NE(refusal(), "") << size << " of " << bytes.size();
  }
}

TEST_F(SessionRefusal, DamagedPagesAreFoundBeforeAnythingIsUsed) {
  write();
  std::string bytes = test::read_bytes(file_);
  bytes.replace(bytes.size() / 2 / 4096 * 4096, 8192, std::string(8192, '\xA5'));
  test::write_bytes(file_, bytes);
  EXPECT_NE(refusal().find("is damaged"), std::string::npos);
}

// Wherever a bit is wrong: the session is refused, or what it gives is sound.
TEST_F(SessionRefusal, NoDamageCrashesTheReader) {
  write();
  const std::string bytes = test::read_bytes(file_);
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 4; ++k) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    test::write_bytes(file_, damaged);
    const std::string said = test::refusal_of([&] {
      const SessionReader session(file_);
      session.for_each_keyframe([](SessionKeyframe&&) {});
      static_cast<void>(session.odometry_edges());
    });
    if (said.empty()) continue;
    EXPECT_NE(said.find(file_.string()), std::string::npos) << said;
  }
}

TEST_F(SessionRefusal, ADamagedKeyframeIsNamed) {
  write();
  run("UPDATE clouds SET points = x'00112233' WHERE keyframe = 7");
  const std::string said =
      test::refusal_of([&] { static_cast<void>(SessionReader(file_).keyframe(7)); });
  EXPECT_NE(said.find("the points of keyframe 7"), std::string::npos) << said;
}

TEST_F(SessionRefusal, ADamagedSessionIsNotCopied) {
  write();
  const std::string bytes = test::read_bytes(file_);
  test::write_bytes(file_, bytes.substr(0, bytes.size() / 2));
  EXPECT_NE(test::refusal_of([&] { copy_session(file_, directory_ / "copy.glint"); }), "");
  EXPECT_EQ(files(), "session.glint ");
}

}  // namespace
}  // namespace glint::slam
