// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/session_store.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>

namespace glint::slam {
namespace {

class SessionStoreTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    info_.pixels_per_column = 64;
    info_.columns_per_frame = 1024;
    info_.columns_per_packet = 16;
    info_.column_window = {0, 1023};
    info_.beam_altitude_deg.assign(64, 1.0);
    info_.beam_azimuth_deg.assign(64, 0.5);
    info_.pixel_shift_by_row.assign(64, 0);
    info_.lidar_mode = "1024x10";
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  static Keyframe keyframe(std::uint64_t id) {
    Keyframe k;
    k.id = id;
    k.estimate.stamp = {static_cast<std::int64_t>(id) * 1'000'000'000};
    k.estimate.T_odom_sensor.translation_m.x() = static_cast<double>(id);
    k.points = {{1.234F, -2.0F, 0.5F, 77.0F}, {1000.0F, 0.0F, 0.0F, 1.0F}};
    return k;
  }

  // The first column of the first row that a query gives, as another program would read it.
  std::string query(const std::string& sql) const {
    sqlite3* db = nullptr;
    sqlite3_open_v2(file_.c_str(), &db, SQLITE_OPEN_READONLY, nullptr);
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr);
    std::string value;
    if (sqlite3_step(statement) == SQLITE_ROW) {
      const void* data = sqlite3_column_blob(statement, 0);
      value.assign(static_cast<const char*>(data),
                   static_cast<std::size_t>(sqlite3_column_bytes(statement, 0)));
    }
    sqlite3_finalize(statement);
    sqlite3_close(db);
    return value;
  }

  const std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() / ("glint-session-" + std::to_string(getpid()));
  const std::filesystem::path file_ = directory_ / "session.glint";
  SensorInfo info_;
};

TEST_F(SessionStoreTest, KeyframesAreThereForOthersWhileItIsOpen) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.add(keyframe(0), {}));
  ASSERT_TRUE(store.add(keyframe(1), {}));
  EXPECT_EQ(query("SELECT count(*) FROM keyframes"), "2");
  EXPECT_EQ(query("SELECT kind FROM edges WHERE from_keyframe=0 AND to_keyframe=1"), "odometry");
  const std::string motion = query("SELECT T_from_to FROM edges");
  double x_m = 0.0;
  ASSERT_EQ(motion.size(), 7 * sizeof(double));
  std::memcpy(&x_m, motion.data(), sizeof x_m);
  EXPECT_DOUBLE_EQ(x_m, 1.0);
}

TEST_F(SessionStoreTest, PointsAreKeptToTheCentimetre) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.add(keyframe(0), {}));
  const std::string points = query("SELECT points FROM keyframes");
  ASSERT_EQ(points.size(), 7U);  // the point 1 km away does not fit and is left out
  std::int16_t x_cm = 0;
  std::memcpy(&x_cm, points.data(), sizeof x_cm);
  EXPECT_EQ(x_cm, 123);
  EXPECT_EQ(static_cast<unsigned char>(points[6]), 77);
}

TEST_F(SessionStoreTest, NoEdgeJoinsSegments) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.add(keyframe(0), {}));
  Keyframe after_a_jump = keyframe(1);
  after_a_jump.estimate.segment = 1;
  ASSERT_TRUE(store.add(after_a_jump, {}));
  EXPECT_EQ(query("SELECT count(*) FROM edges"), "0");
}

TEST_F(SessionStoreTest, EventsAndMetaAreKept) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.apply({{{{5}, "tracking", R"({"state":"LOST"})"}}, {}, {}, {}}));
  EXPECT_EQ(query("SELECT data FROM events WHERE t_ns=5"), R"({"state":"LOST"})");
  EXPECT_EQ(query("SELECT value FROM meta WHERE key='schema_version'"), "1");
}

TEST_F(SessionStoreTest, ALoopMovesKeyframesAndNothingElseOfThem) {
  SessionStore store(file_, {});
  for (std::uint64_t id = 0; id < 3; ++id) ASSERT_TRUE(store.add(keyframe(id), {}));
  const std::string points = query("SELECT points FROM keyframes WHERE id=2");
  const LoopEdge loop{0, 2, {}, Eigen::Matrix<double, 6, 6>::Identity()};
  const Pose moved{Eigen::Quaterniond::Identity(), {7.5, 0, 0}};
  ASSERT_TRUE(store.apply({{}, {loop}, {}, {{1, moved}, {2, moved}}}));
  EXPECT_EQ(query("SELECT count(*) FROM edges WHERE kind='loop'"), "1");
  const std::string pose = query("SELECT T_map_sensor FROM keyframes WHERE id=2");
  double x_m = 0.0;
  ASSERT_EQ(pose.size(), 7 * sizeof(double));
  std::memcpy(&x_m, pose.data(), sizeof x_m);
  EXPECT_DOUBLE_EQ(x_m, 7.5);
  EXPECT_EQ(query("SELECT points FROM keyframes WHERE id=2"), points);
  ASSERT_TRUE(store.apply({{}, {}, {loop}, {}}));
  EXPECT_EQ(query("SELECT count(*) FROM edges WHERE kind='loop'"), "0");
  EXPECT_EQ(query("SELECT count(*) FROM edges WHERE kind='odometry'"), "2");
}

TEST_F(SessionStoreTest, ChangesThatFailLeaveNothingBehind) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.add(keyframe(0), {}));
  EXPECT_FALSE(store.apply({{{{5}, "loop", "{}"}}, {}, {}, {{77, {}}}}));  // no such keyframe
  EXPECT_NE(store.error(), "");
  EXPECT_EQ(query("SELECT count(*) FROM events"), "0");
  EXPECT_TRUE(store.add(keyframe(1), {}));
}

TEST_F(SessionStoreTest, TheSensorIsTheOneSetLast) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.set_sensor(info_));
  info_.lidar_mode = "2048x10";
  ASSERT_TRUE(store.set_sensor(info_));
  const std::string sensor = query("SELECT value FROM meta WHERE key='sensor'");
  EXPECT_EQ(parse_sensor_info(sensor, "session").lidar_mode, "2048x10");
}

TEST_F(SessionStoreTest, AKeyframeThatCannotBeAddedLeavesTheFileWhole) {
  SessionStore store(file_, {});
  ASSERT_TRUE(store.add(keyframe(0), {}));
  EXPECT_FALSE(store.add(keyframe(0), {}));  // the id is taken
  EXPECT_NE(store.error(), "");
  EXPECT_TRUE(store.add(keyframe(1), {}));
  EXPECT_EQ(query("SELECT count(*) FROM keyframes"), "2");
}

TEST_F(SessionStoreTest, ADirectoryThatIsNotThereIsNamed) {
  try {
    const SessionStore store(directory_ / "none" / "s.glint", {});
    FAIL() << "was created";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("none/s.glint"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace glint::slam
