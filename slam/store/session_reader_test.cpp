// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_reader.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstring>

#include "slam/loops/place.hpp"
#include "slam/store/point_codec.hpp"
#include "slam/store/session_map.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

using test::sample_keyframe;
using test::sample_map_pose;

constexpr std::uint64_t kKeyframes = 12;

class SessionReaderTest : public test::InDirectory {
 protected:
  void fill(SessionStore& store) const {
    store.set_meta("preset", "paper");
    store.set_sensor(test::sample_sensor());
    for (std::uint64_t id = 0; id < kKeyframes; ++id) {
      store.add(sample_keyframe(id), sample_map_pose(id));
    }
    store.apply({{{{5}, "loop", R"({"from":1})"}}, {test::sample_loop(1, 9)}, {}, {}});
  }
  void write() const {
    SessionStore store(file_);
    fill(store);
  }
};

void expect_same_pose(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.translation_m, b.translation_m);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

void expect_same_estimate(const OdometryEstimate& is, const OdometryEstimate& was) {
  EXPECT_EQ(is.sequence, was.sequence);
  EXPECT_EQ(is.frame_id, was.frame_id);
  EXPECT_EQ(is.stamp, was.stamp);
  EXPECT_EQ(is.segment, was.segment);
  EXPECT_EQ(is.state, was.state);
  EXPECT_EQ(is.completeness, was.completeness);
  EXPECT_EQ(is.covariance, was.covariance);
  expect_same_pose(is.T_odom_sensor, was.T_odom_sensor);
}

TEST_F(SessionReaderTest, KeyframesComeBackAsTheyWere) {
  write();
  std::uint64_t id = 0;
  SessionReader(file_).for_each_keyframe([&](SessionKeyframe&& read) {
    const Keyframe was = sample_keyframe(id);
    const Keyframe& is = read.keyframe;
    EXPECT_EQ(is.id, id);
    expect_same_estimate(is.estimate, was.estimate);
    expect_same_pose(read.T_map_sensor, sample_map_pose(id));
    if (id > 0) {
      EXPECT_EQ(is.edge_covariance, was.edge_covariance);
    }
    ASSERT_EQ(is.gravity.has_value(), was.gravity.has_value());
    if (was.gravity) {
      EXPECT_EQ(is.gravity->up, was.gravity->up);
      EXPECT_EQ(is.gravity->bias_share, was.gravity->bias_share);
      EXPECT_EQ(is.gravity->sigma_rad, was.gravity->sigma_rad);
    }
    ASSERT_EQ(is.points.size(), was.points.size());
    for (std::size_t i = 0; i < was.points.size(); ++i) {
      EXPECT_NEAR(is.points[i].x_m, was.points[i].x_m, kPointQuantum_m / 2 + 1e-5);
    }
    EXPECT_EQ(is.features.descriptors, was.features.descriptors);
    EXPECT_EQ(is.features.points_m, was.features.points_m);
    ++id;
  });
  EXPECT_EQ(id, kKeyframes);
}

TEST_F(SessionReaderTest, OneKeyframeIsFoundByItsId) {
  write();
  const SessionReader session(file_);
  const auto seventh = session.keyframe(7);
  ASSERT_TRUE(seventh);
  expect_same_pose(seventh->T_map_sensor, sample_map_pose(7));
  EXPECT_FALSE(session.keyframe(kKeyframes));
}

TEST_F(SessionReaderTest, EdgesEventsSegmentsAndMetaComeBack) {
  write();
  const SessionReader session(file_);
  const auto odometry = session.odometry_edges();
  ASSERT_EQ(odometry.size(), kKeyframes - 1);
  EXPECT_EQ(odometry[3].from, 3U);
  EXPECT_EQ(odometry[3].covariance, sample_keyframe(4).edge_covariance);
  expect_same_pose(odometry[3].T_from_to, sample_keyframe(3).estimate.T_odom_sensor.inverse() *
                                              sample_keyframe(4).estimate.T_odom_sensor);
  const auto loops = session.loop_edges();
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].to, 9U);
  EXPECT_EQ(loops[0].covariance, test::sample_loop(1, 9).covariance);
  expect_same_pose(loops[0].T_from_to, test::sample_loop(1, 9).T_from_to);
  const auto events = session.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].data, R"({"from":1})");
  const auto segments = session.segments();
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_EQ(segments[0].keyframes, kKeyframes);
  EXPECT_EQ(segments[0].last_stamp, sample_keyframe(kKeyframes - 1).estimate.stamp);
  EXPECT_EQ(session.meta("preset"), "paper");
  EXPECT_EQ(session.meta("no such key"), "");
  EXPECT_EQ(session.sensors().at(0).info.lidar_mode, "1024x10");
}

TEST_F(SessionReaderTest, ReadingLeavesNoTrace) {
  write();
  const std::string bytes = test::read_bytes(file_);
  EXPECT_EQ(files(), "session.glint ");
  EXPECT_EQ(SessionReader(file_).poses().size(), kKeyframes);
  EXPECT_EQ(files(), "session.glint ");
  EXPECT_EQ(test::read_bytes(file_), bytes);
}

TEST_F(SessionReaderTest, ASessionThatIsBeingWrittenIsReadAsItIsAtOneMoment) {
  SessionStore store(file_);
  fill(store);
  ASSERT_TRUE(store.commit());
  const std::string log = test::read_bytes(file_.string() + "-wal");
  const SessionReader session(file_);
  EXPECT_EQ(session.keyframe_count(), kKeyframes);
  store.add(sample_keyframe(kKeyframes), {});
  ASSERT_TRUE(store.commit());
  EXPECT_EQ(session.poses().size(), kKeyframes);
  EXPECT_EQ(SessionReader(file_).poses().size(), kKeyframes + 1);
  EXPECT_EQ(test::read_bytes(file_.string() + "-wal").substr(0, log.size()), log);
}

// As a power cut leaves it, or a copy of the files: the log's index is no part of it.
TEST_F(SessionReaderTest, ALogThatWasLeftBehindIsReadAndLeftAsItIs) {
  std::string bytes;
  std::string log;
  {
    SessionStore store(file_);
    fill(store);
    ASSERT_TRUE(store.commit());
    bytes = test::read_bytes(file_);
    log = test::read_bytes(file_.string() + "-wal");
  }
  const std::filesystem::path left = directory_ / "left.glint";
  test::write_bytes(left, bytes);
  test::write_bytes(left.string() + "-wal", log);
  EXPECT_EQ(SessionReader(left).poses().size(), kKeyframes);
  EXPECT_EQ(files(), "left.glint left.glint-wal session.glint ");
  EXPECT_EQ(test::read_bytes(left), bytes);
  EXPECT_EQ(test::read_bytes(left.string() + "-wal"), log);
}

TEST_F(SessionReaderTest, TheMapIsMadeOfTheKeyframesWhereTheyAreNow) {
  Keyframe keyframe = sample_keyframe(0);
  keyframe.points = {{1, 0, 0, 9}, {1.001F, 0, 0, 9}, {2, 0, 0, 9}};
  {
    SessionStore store(file_);
    store.set_meta("map_voxel_m", "0.5");
    store.add(keyframe, {});
    store.apply({{}, {}, {}, {{0, {Eigen::Quaterniond::Identity(), {0, 0, 30.1}}}}});
  }
  const auto map = session_map(SessionReader(file_));
  EXPECT_EQ(map->keyframe_count, 1U);
  ASSERT_EQ(map->point_count, 2U);
  EXPECT_NEAR(map->tiles.at(0)->points[0].z_m, 30.1, 1e-4);
}

// What version 1 wrote, with its points of seven bytes.
constexpr const char* kVersion1 = R"sql(
PRAGMA journal_mode = WAL;
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE keyframes (id INTEGER PRIMARY KEY, t_ns INTEGER NOT NULL, frame_id INTEGER NOT NULL,
  segment INTEGER NOT NULL, T_odom_sensor BLOB NOT NULL, T_map_sensor BLOB NOT NULL,
  points BLOB NOT NULL);
CREATE TABLE edges (id INTEGER PRIMARY KEY, from_keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  to_keyframe INTEGER NOT NULL REFERENCES keyframes(id), kind TEXT NOT NULL,
  T_from_to BLOB NOT NULL, covariance BLOB NOT NULL);
CREATE TABLE events (id INTEGER PRIMARY KEY, t_ns INTEGER NOT NULL, kind TEXT NOT NULL,
  data TEXT NOT NULL);
INSERT INTO meta VALUES ('schema_version', '1'), ('preset', 'full');
INSERT INTO keyframes VALUES (0, 1000, 17, 0, zeroblob(48) || x'000000000000F03F',
  zeroblob(48) || x'000000000000F03F', x'7B0038FF320057');
)sql";

class OldSession : public SessionReaderTest {
 protected:
  OldSession() {
    sqlite3* db = nullptr;
    sqlite3_open(file_.c_str(), &db);
    EXPECT_EQ(sqlite3_exec(db, kVersion1, nullptr, nullptr, nullptr), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db,
                           ("INSERT INTO meta VALUES ('sensor', '" +
                            to_metadata_json(test::sample_sensor()) + "')")
                               .c_str(),
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(db);
  }
  static void expect_its_content(const SessionReader& session) {
    const auto keyframe = session.keyframe(0);
    ASSERT_TRUE(keyframe);
    EXPECT_EQ(keyframe->keyframe.estimate.stamp.ns, 1000);
    EXPECT_EQ(keyframe->keyframe.estimate.sequence, 17U);
    ASSERT_EQ(keyframe->keyframe.points.size(), 1U);
    const MapPoint& point = keyframe->keyframe.points[0];
    EXPECT_FLOAT_EQ(point.x_m, 1.23F);
    EXPECT_FLOAT_EQ(point.y_m, -2.0F);
    EXPECT_FLOAT_EQ(point.z_m, 0.5F);
    EXPECT_EQ(point.intensity, 87.0F);
    EXPECT_EQ(session.meta("preset"), "full");
    EXPECT_EQ(session.sensors().at(0).info.lidar_mode, "1024x10");
  }
};

TEST_F(OldSession, IsReadWithoutBeingChanged) {
  const std::string bytes = test::read_bytes(file_);
  expect_its_content(SessionReader(file_));
  EXPECT_EQ(test::read_bytes(file_), bytes);
  EXPECT_EQ(files(), "session.glint ");
}

TEST_F(OldSession, IsMigratedWhereItIsContinued) {
  {
    SessionStore store(file_, {.continues = true});
    store.add(sample_keyframe(1), {});
  }
  EXPECT_EQ(test::query(file_, "PRAGMA user_version"), "2");
  const SessionReader session(file_);
  expect_its_content(session);
  EXPECT_EQ(session.keyframe_count(), 2U);
}

}  // namespace
}  // namespace glint::slam
