// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_copy.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "driver/core/crc64.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

class SessionCopyTest : public test::InDirectory {
 protected:
  // Some 10 MB, so that a copy takes several steps.
  static void fill(SessionStore& store) {
    for (std::uint64_t id = 0; id < 60; ++id) store.add(test::sample_keyframe(id, 20'000), {});
    EXPECT_TRUE(store.commit());
  }
  const std::filesystem::path copy_ = directory_ / "copy.glint";
};

TEST_F(SessionCopyTest, ACopyIsWholeAndSaysWhatItIs) {
  {
    SessionStore store(file_);
    fill(store);
  }
  std::vector<double> shares;
  const auto copy = copy_session(file_, copy_, {}, [&](double share) {
    shares.push_back(share);
    return true;
  });
  ASSERT_TRUE(copy);
  const std::string bytes = test::read_bytes(copy_);
  EXPECT_EQ(copy->file, copy_);
  EXPECT_EQ(copy->bytes, bytes.size());
  EXPECT_EQ(copy->checksum, crc64(std::as_bytes(std::span(bytes))));
  ASSERT_GT(shares.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_EQ(SessionReader(copy_).keyframe_count(), 60U);
  EXPECT_EQ(files(), "copy.glint session.glint ");
  // Others who read it leave nothing beside it either.
  EXPECT_EQ(test::query(copy_, "PRAGMA journal_mode"), "delete");
}

TEST_F(SessionCopyTest, WhatIsBeingWrittenIsCopiedAsItIsAtOneMoment) {
  SessionStore store(file_);
  fill(store);
  std::uint64_t next = 60;
  const auto copy = copy_session(file_, copy_, {}, [&](double) {
    store.add(test::sample_keyframe(next++), {});
    return store.commit();
  });
  ASSERT_TRUE(copy);
  EXPECT_GT(next, 61U);
  EXPECT_EQ(SessionReader(copy_).keyframe_count(), 60U);
  EXPECT_EQ(SessionReader(file_).keyframe_count(), next);
}

TEST_F(SessionCopyTest, ACopyGivenUpLeavesWhatWasThere) {
  SessionStore store(file_);
  fill(store);
  test::write_bytes(copy_, "before");
  EXPECT_FALSE(copy_session(file_, copy_, {}, [](double) { return false; }));
  EXPECT_EQ(test::read_bytes(copy_), "before");
  EXPECT_EQ(files(), "copy.glint session.glint session.glint-shm session.glint-wal ");
  ASSERT_TRUE(copy_session(file_, copy_));
  EXPECT_EQ(SessionReader(copy_).keyframe_count(), 60U);
}

TEST_F(SessionCopyTest, ADirectoryThatIsNotThereIsNamed) {
  { SessionStore(file_).add(test::sample_keyframe(0), {}); }
  const std::string said =
      test::refusal_of([&] { copy_session(file_, directory_ / "none" / "copy.glint"); });
  EXPECT_NE(said.find("none/copy.glint"), std::string::npos) << said;
}

TEST_F(SessionCopyTest, ACopyCanBeContinued) {
  { SessionStore(file_).add(test::sample_keyframe(0), {}); }
  ASSERT_TRUE(copy_session(file_, copy_));
  { SessionStore(copy_, {.continues = true}).add(test::sample_keyframe(1), {}); }
  EXPECT_EQ(SessionReader(copy_).keyframe_count(), 2U);
}

}  // namespace
}  // namespace glint::slam
