// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/trajectory_history.hpp"

#include <gtest/gtest.h>

namespace glint::daemon {
namespace {

PoseRecord record_at(std::int64_t ns, double x_m = 0.0, std::uint32_t segment = 0) {
  PoseRecord record;
  record.stamp.ns = ns;
  record.T_odom_sensor.translation_m.x() = x_m;
  record.segment = segment;
  record.state = slam::TrackingState::kTracking;
  return record;
}

TEST(TrajectoryHistoryTest, RecordsAreFoundByIndexAndTimeAcrossChunks) {
  TrajectoryHistory history;
  for (std::int64_t k = 0; k < 1000; ++k) history.append(record_at(10 * k));
  ASSERT_EQ(history.end(), 1000U);
  for (std::uint64_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(history.at(k).stamp.ns, static_cast<std::int64_t>(10 * k));
  }
  EXPECT_EQ(history.first_after({-5}), 0U);
  EXPECT_EQ(history.first_after({0}), 1U);
  EXPECT_EQ(history.first_after({5115}), 512U);
  EXPECT_EQ(history.first_after({99'999}), 1000U);
}

TEST(TrajectoryHistoryTest, TheOldestChunkGoesAndIndicesStay) {
  TrajectoryHistory history(1000);
  for (std::int64_t k = 0; k < 10'000; ++k) history.append(record_at(k));
  EXPECT_EQ(history.end(), 10'000U);
  EXPECT_GE(history.end() - history.first(), 768U);
  EXPECT_LE(history.end() - history.first(), 1024U);
  EXPECT_EQ(history.at(history.first()).stamp.ns, static_cast<std::int64_t>(history.first()));
}

TEST(TrajectoryHistoryTest, ACopyDoesNotChange) {
  TrajectoryHistory history;
  for (std::int64_t k = 0; k < 300; ++k) history.append(record_at(k));
  const TrajectoryHistory copy = history;
  for (std::int64_t k = 300; k < 900; ++k) history.append(record_at(k));
  EXPECT_EQ(copy.end(), 300U);
  EXPECT_EQ(copy.at(299).stamp.ns, 299);
}

TEST(TrajectoryHistoryTest, AClockThatGoesBackStartsANewHistory) {
  TrajectoryHistory history;
  for (std::int64_t k = 0; k < 300; ++k) history.append(record_at(1000 + k));
  history.append(record_at(5));
  EXPECT_EQ(history.first(), 300U);
  EXPECT_EQ(history.end(), 301U);
  EXPECT_EQ(history.at(300).stamp.ns, 5);
}

TEST(TrajectoryHistoryTest, PosesBetweenRecordsAreInterpolated) {
  TrajectoryHistory history;
  history.append(record_at(100, 1.0));
  history.append(record_at(200, 2.0));
  EXPECT_DOUBLE_EQ(pose_at(history, {125})->T_odom_sensor.translation_m.x(), 1.25);
  EXPECT_EQ(pose_at(history, {100})->T_odom_sensor.translation_m.x(), 1.0);
  EXPECT_EQ(pose_at(history, {200})->T_odom_sensor.translation_m.x(), 2.0);
}

TEST(TrajectoryHistoryTest, OutsideTheSpanAndAcrossARestartThereIsNoPose) {
  TrajectoryHistory history;
  EXPECT_FALSE(pose_at(history, {1}).has_value());
  history.append(record_at(100, 1.0, 0));
  history.append(record_at(200, 2.0, 1));
  EXPECT_FALSE(pose_at(history, {99}).has_value());
  EXPECT_FALSE(pose_at(history, {201}).has_value());
  EXPECT_FALSE(pose_at(history, {150}).has_value());
  EXPECT_TRUE(pose_at(history, {200}).has_value());
}

TEST(TrajectoryHistoryTest, TheWorseStateOfTheTwoIsTold) {
  TrajectoryHistory history;
  history.append(record_at(100));
  PoseRecord lost = record_at(200);
  lost.state = slam::TrackingState::kLost;
  history.append(lost);
  EXPECT_EQ(pose_at(history, {150})->state, slam::TrackingState::kLost);
}

}  // namespace
}  // namespace glint::daemon
