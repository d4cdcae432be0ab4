// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_store.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>

#include "slam/store/session_reader.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

using test::query;
using test::sample_keyframe;

std::int64_t now_ns = 0;
constexpr Clock kTestClock{[] { return now_ns; }, [] { return std::int64_t{0}; }};

class SessionStoreTest : public test::InDirectory {
 protected:
  [[nodiscard]] std::string sql(const std::string& text) const { return query(file_, text); }
};

TEST_F(SessionStoreTest, KeyframesAreThereForOthersWhileItIsOpen) {
  SessionStore store(file_);
  store.add(sample_keyframe(0), {});
  store.add(sample_keyframe(1), {});
  ASSERT_TRUE(store.commit());
  EXPECT_EQ(sql("SELECT count(*) FROM keyframes"), "2");
  EXPECT_EQ(sql("SELECT kind FROM edges WHERE from_keyframe=0 AND to_keyframe=1"), "odometry");
}

TEST_F(SessionStoreTest, ItSaysWhatItIs) {
  SessionStore store(file_);
  EXPECT_EQ(sql("PRAGMA application_id"), std::to_string(0x474C4E54));
  EXPECT_EQ(sql("PRAGMA user_version"), "2");
  EXPECT_EQ(sql("PRAGMA journal_mode"), "wal");
}

TEST_F(SessionStoreTest, WhatWasAddedIsCommittedHalfASecondLaterAtMost) {
  now_ns = 5'000'000'000;
  SessionStore store(file_, {.clock = kTestClock});
  store.add(sample_keyframe(0), {});
  EXPECT_TRUE(store.commit_if_due());
  EXPECT_EQ(sql("SELECT count(*) FROM keyframes"), "0");
  now_ns += 500'000'000;
  EXPECT_TRUE(store.commit_if_due());
  EXPECT_EQ(sql("SELECT count(*) FROM keyframes"), "1");
}

TEST_F(SessionStoreTest, NoEdgeJoinsSegments) {
  SessionStore store(file_);
  store.add(sample_keyframe(0), {});
  Keyframe after_a_jump = sample_keyframe(1);
  after_a_jump.estimate.segment = 1;
  store.add(after_a_jump, {});
  ASSERT_TRUE(store.commit());
  EXPECT_EQ(sql("SELECT count(*) FROM edges"), "0");
  EXPECT_EQ(sql("SELECT count(*) FROM segments"), "2");
}

TEST_F(SessionStoreTest, ALoopMovesKeyframesAndNothingElseOfThem) {
  SessionStore store(file_);
  for (std::uint64_t id = 0; id < 3; ++id) store.add(sample_keyframe(id), {});
  const LoopEdge loop = test::sample_loop(0, 2);
  const Pose moved{Eigen::Quaterniond::Identity(), {7.5, 0, 0}};
  store.apply({{}, {loop}, {}, {{1, moved}, {2, moved}}});
  ASSERT_TRUE(store.commit());
  const auto poses = SessionReader(file_).poses();
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].T_map_sensor.translation_m.x(), 0.0);
  EXPECT_EQ(poses[2].T_map_sensor.translation_m.x(), 7.5);
  EXPECT_EQ(poses[2].T_odom_sensor.translation_m.x(), 2.0);
  EXPECT_EQ(sql("SELECT count(*) FROM edges WHERE kind='loop'"), "1");
  store.apply({{}, {}, {loop}, {}});
  ASSERT_TRUE(store.commit());
  EXPECT_EQ(sql("SELECT count(*) FROM edges WHERE kind='loop'"), "0");
  EXPECT_EQ(sql("SELECT count(*) FROM edges WHERE kind='odometry'"), "2");
}

TEST_F(SessionStoreTest, AKeyframeWhoseIdIsTakenIsNotInTheWayOfOthers) {
  SessionStore store(file_);
  store.add(sample_keyframe(0), {});
  store.add(sample_keyframe(0), {});
  store.add(sample_keyframe(1), {});
  ASSERT_TRUE(store.commit());
  EXPECT_EQ(store.missing_keyframes(), 1U);
  EXPECT_NE(store.error(), "");
  EXPECT_EQ(sql("SELECT count(*) FROM keyframes"), "2");
}

TEST_F(SessionStoreTest, TheSensorIsKeptFromTheKeyframeOnThatIsItsOwn) {
  SensorInfo info = test::sample_sensor();
  {
    SessionStore store(file_);
    store.set_sensor(info);
    info.lidar_mode = "512x10";
    store.set_sensor(info);
    store.add(sample_keyframe(0), {});
    info.lidar_mode = "2048x10";
    store.set_sensor(info);
  }
  const auto sensors = SessionReader(file_).sensors();
  ASSERT_EQ(sensors.size(), 2U);
  EXPECT_EQ(sensors[0].info.lidar_mode, "512x10");
  EXPECT_EQ(sensors[1].first_keyframe, 1U);
  EXPECT_EQ(sensors[1].info.lidar_mode, "2048x10");
}

TEST_F(SessionStoreTest, ItGoesOnWhereItWasLeft) {
  { SessionStore(file_).add(sample_keyframe(0), {}); }
  {
    SessionStore store(file_, {.continues = true});
    store.add(sample_keyframe(1), {});
  }
  EXPECT_EQ(SessionReader(file_).keyframe_count(), 2U);
  // As if there had been a pause: nothing says how the sensor came from one to the other.
  EXPECT_TRUE(SessionReader(file_).odometry_edges().empty());
  { SessionStore(file_).add(sample_keyframe(5), {}); }
  EXPECT_EQ(SessionReader(file_).keyframe_count(), 1U);
}

/// While it lives files cannot grow beyond a size, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(SessionStoreTest, WhatAFullDiskDidNotTakeIsWrittenWhenThereIsRoom) {
  SessionStore store(file_);
  store.add(sample_keyframe(0), {});
  ASSERT_TRUE(store.commit());
  {
    const FullDisk full(8192);
    store.add(sample_keyframe(1, 5000), {});
    EXPECT_FALSE(store.commit());
    EXPECT_EQ(store.missing_keyframes(), 1U);
    EXPECT_NE(store.error(), "");
  }
  EXPECT_EQ(sql("SELECT count(*) FROM keyframes"), "1");
  EXPECT_TRUE(store.commit());
  EXPECT_EQ(store.missing_keyframes(), 0U);
  EXPECT_EQ(store.failures(), 1U);
  EXPECT_EQ(sql("SELECT count(*) FROM keyframes"), "2");
}

TEST_F(SessionStoreTest, WhatWaitsForTheDiskIsBounded) {
  SessionStore store(file_, {.most_waiting_bytes = 100'000});
  {
    const FullDisk full(8192);
    for (std::uint64_t id = 0; id < 50; ++id) store.add(sample_keyframe(id, 2000), {});
    EXPECT_FALSE(store.commit());
    EXPECT_EQ(store.missing_keyframes(), 50U);
  }
  EXPECT_TRUE(store.commit());
  const std::size_t kept = SessionReader(file_).keyframe_count();
  EXPECT_GT(kept, 5U);
  EXPECT_EQ(store.missing_keyframes(), 50U - kept);
}

TEST_F(SessionStoreTest, ADirectoryThatIsNotThereIsNamed) {
  const std::string said =
      test::refusal_of([&] { const SessionStore store(directory_ / "none" / "s.glint"); });
  EXPECT_NE(said.find("none/s.glint"), std::string::npos) << said;
}

}  // namespace
}  // namespace glint::slam
