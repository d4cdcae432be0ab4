// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/backend.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

namespace glint::slam {
namespace {

constexpr std::uint64_t kRound = 60;

/// Round a circle of 10 m radius, sixty keyframes a round.
Pose true_pose(std::uint64_t k) {
  const double angle_rad = 2.0 * M_PI * static_cast<double>(k) / kRound;
  return {so3_exp({0, 0, angle_rad}),
          {10.0 * std::sin(angle_rad), 10.0 - 10.0 * std::cos(angle_rad), 0.0}};
}

/// Keyframe `k` of a sensor whose odometry says it turned 1 % too far. Its points lie on posts a
/// metre to its side, one for each place of the round.
Keyframe keyframe(std::uint64_t k) {
  Keyframe out;
  out.id = k;
  out.estimate.sequence = 5 * k;
  out.estimate.stamp.ns = static_cast<std::int64_t>(k) * 500'000'000;
  Twist step = se3_log(true_pose(0).inverse() * true_pose(1));
  step[5] *= 1.01;
  out.estimate.T_odom_sensor = se3_exp(step * static_cast<double>(k));
  std::mt19937 random(static_cast<std::uint32_t>(k));
  std::uniform_real_distribution<float> height(0.0F, 2.0F);
  for (int i = 0; i < 50; ++i) out.points.push_back({0.0F, -1.0F, height(random), 10.0F});
  return out;
}

LoopEdge true_loop(std::uint64_t from, std::uint64_t to) {
  return {from, to, true_pose(from).inverse() * true_pose(to),
          Eigen::Matrix<double, 6, 6>::Identity() * 1e-4};
}

/// Loops that a test knows of, by the keyframe that brings them.
LoopSource known_loops(std::map<std::uint64_t, LoopEdge> edges) {
  return {[edges = std::move(edges)](const Keyframe& k) {
    LoopSearch found;
    found.candidates.push_back({k.id > 5 ? k.id - 5 : 0, k.id, false, "too near", 0.4});
    if (const auto edge = edges.find(k.id); edge != edges.end()) {
      found.edges.push_back(edge->second);
      found.candidates.push_back({edge->second.from, k.id, true, "", 0.9, 80, 60, 0.7, 0.02});
    }
    return found;
  }};
}

double error_m(const MapCorrection& correction, std::uint64_t k) {
  const OdometryEstimate estimate = keyframe(k).estimate;
  const Pose pose =
      correction.map_pose(0, static_cast<double>(estimate.sequence), estimate.T_odom_sensor);
  return (pose.translation_m - true_pose(k).translation_m).norm();
}

TEST(Backend, ALoopMovesTheMapFrameAndStepsTheEpoch) {
  Backend backend({}, {}, {}, known_loops({{kRound, true_loop(0, kRound)}}));
  for (std::uint64_t k = 0; k < kRound; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.correction().epoch, 0U);
  const double before_m = error_m(backend.correction(), kRound);
  ASSERT_GT(before_m, 0.3);

  backend.process(keyframe(kRound));
  EXPECT_EQ(backend.correction().epoch, 1U);
  EXPECT_EQ(backend.loops_accepted(), 1U);
  EXPECT_EQ(backend.snapshot()->epoch, 1U);
  EXPECT_LT(error_m(backend.correction(), kRound), 0.02);
  EXPECT_LT(error_m(backend.correction(), kRound / 2), 0.5 * before_m);
  // What comes next goes on from there, without another jump.
  backend.process(keyframe(kRound + 1));
  EXPECT_EQ(backend.correction().epoch, 1U);
  EXPECT_LT(error_m(backend.correction(), kRound + 1), 0.05);
}

TEST(Backend, ScansBetweenKeyframesMoveWithThem) {
  Backend backend({}, {}, {}, known_loops({{kRound, true_loop(0, kRound)}}));
  for (std::uint64_t k = 0; k <= kRound; ++k) backend.process(keyframe(k));
  const MapCorrection& correction = backend.correction();
  Pose last = correction.map_pose(0, 0.0, keyframe(0).estimate.T_odom_sensor);
  for (int scan = 1; scan <= static_cast<int>(5 * kRound); ++scan) {
    const auto k = static_cast<std::uint64_t>(scan / 5);
    const Pose T_odom_sensor = interpolate(keyframe(k).estimate.T_odom_sensor,
                                           keyframe(k + 1).estimate.T_odom_sensor, scan % 5 / 5.0);
    const Pose pose = correction.map_pose(0, scan, T_odom_sensor);
    const double step_m = (last.inverse() * pose).translation_m.norm();
    EXPECT_NEAR(step_m, 2.0 * M_PI * 10.0 / (5 * kRound), 0.02) << scan;
    last = pose;
  }
}

TEST(Backend, NoPointOfTheMapIsLostWhenItMoves) {
  Backend backend({}, {}, {}, known_loops({{kRound, true_loop(0, kRound)}}));
  for (std::uint64_t k = 0; k < kRound; ++k) backend.process(keyframe(k));
  const std::size_t before = backend.snapshot()->point_count;
  Backend without({}, {}, {}, {});
  for (std::uint64_t k = 0; k <= kRound; ++k) without.process(keyframe(k));
  const std::size_t brought = without.snapshot()->point_count - before;
  backend.process(keyframe(kRound));
  EXPECT_EQ(backend.snapshot()->point_count, before + brought);
  std::size_t in_tiles = 0;
  double largest_m = 0.0;
  for (const auto& tile : backend.snapshot()->tiles) {
    in_tiles += tile->points.size();
    for (const MapPoint& p : tile->points) {
      // The posts stand on a circle of 11 m about the one that was walked.
      largest_m = std::max(largest_m, std::abs(std::hypot(p.x_m, p.y_m - 10.0F) - 11.0));
    }
  }
  EXPECT_EQ(in_tiles, before + brought);
  EXPECT_LT(largest_m, 0.25);
}

TEST(Backend, EveryCandidateIsReportedWithItsFigures) {
  LoopEdge wrong = true_loop(4, kRound + 4);
  wrong.T_from_to.translation_m.x() += 5.0;
  std::map<std::uint64_t, LoopEdge> edges{{kRound + 4, wrong}};
  for (const std::uint64_t k : {0, 1, 2, 3}) edges[kRound + k] = true_loop(k, kRound + k);
  Backend backend({}, {}, {}, known_loops(edges));
  for (std::uint64_t k = 0; k < kRound; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.loops_rejected(), kRound);

  backend.process(keyframe(kRound));
  ASSERT_EQ(backend.loop_reports().size(), 2U);
  const auto closed = to_json(backend.loop_reports()[1]);
  EXPECT_EQ(closed["from"], 0);
  EXPECT_EQ(closed["to"], kRound);
  EXPECT_EQ(closed["accepted"], true);
  EXPECT_EQ(closed["inliers"], 60);
  EXPECT_GT(closed["residual_before"]["distance_m"], 0.3);
  EXPECT_LT(closed["residual_after"]["distance_m"], 0.02);
  EXPECT_GT(closed["largest_correction_m"], 0.2);
  EXPECT_EQ(to_json(backend.loop_reports()[0])["reason"], "too near");

  for (std::uint64_t k = kRound + 1; k < kRound + 4; ++k) backend.process(keyframe(k));
  const MapCorrection before = backend.correction();
  backend.process(keyframe(kRound + 4));
  const auto refused = to_json(backend.loop_reports()[1]);
  EXPECT_EQ(refused["accepted"], false);
  EXPECT_EQ(refused["reason"], "other loops contradict it");
  EXPECT_EQ(backend.loops_accepted(), 4U);
  EXPECT_EQ(backend.loops_rejected(), kRound + 6);
  EXPECT_LT(error_m(backend.correction(), kRound + 4), error_m(before, kRound + 4) + 0.01);
}

TEST(Backend, LoopsThatComeTogetherAreOneCorrectionAndAWrongOneAmongThemGoes) {
  LoopEdge wrong = true_loop(1, kRound + 1);
  wrong.T_from_to.translation_m.x() += 5.0;
  const auto all_at_once = [&](const Keyframe& k) {
    LoopSearch found;
    if (k.id != kRound + 4) return found;
    found.edges = {true_loop(4, kRound + 4), wrong, true_loop(2, kRound + 2),
                   true_loop(3, kRound + 3)};
    return found;
  };
  Backend backend({}, {}, {}, {all_at_once});
  for (std::uint64_t k = 0; k <= kRound + 4; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.correction().epoch, 1U);
  EXPECT_EQ(backend.loops_accepted(), 3U);
  EXPECT_EQ(backend.loops_rejected(), 1U);
  ASSERT_EQ(backend.loop_reports().size(), 4U);
  for (const LoopReport& report : backend.loop_reports()) {
    EXPECT_EQ(report.candidate.accepted, report.candidate.from != 1);
    EXPECT_EQ(report.candidate.to, kRound + report.candidate.from);
  }
  EXPECT_EQ(backend.loop_reports()[1].candidate.reason, "other loops contradict it");
  EXPECT_LT(error_m(backend.correction(), kRound + 4), 0.05);
}

TEST(Backend, LoopsThatFitMoveThePosesAtTheEndOnly) {
  std::map<std::uint64_t, LoopEdge> edges;
  for (const std::uint64_t k : {0, 1, 2, 3, 4}) edges[kRound + k] = true_loop(k, kRound + k);
  Backend backend({}, {}, {}, known_loops(edges));
  for (std::uint64_t k = 0; k < kRound + 5; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.loops_accepted(), 5U);
  EXPECT_EQ(backend.correction().epoch, 1U);
  backend.finish();
  EXPECT_EQ(backend.correction().epoch, 2U);
  backend.finish();
  EXPECT_EQ(backend.correction().epoch, 2U);
}

TEST(Backend, LoopsMayBeSwitchedOff) {
  SlamConfig config;
  config.loops = false;
  Backend backend(config, {}, {}, known_loops({{kRound, true_loop(0, kRound)}}));
  for (std::uint64_t k = 0; k <= kRound; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.correction().epoch, 0U);
  EXPECT_EQ(backend.loops_rejected(), 0U);
}

TEST(Backend, ASegmentWithoutALoopGoesOnFromTheHeldPoseAndJumpsWithIts) {
  Backend backend({}, {}, {}, known_loops({{kRound + 30, true_loop(30, kRound + 30)}}));
  const Pose carried_off{so3_exp({0, 0, 1.0}), {4.0, 3.0, 0.0}};
  for (std::uint64_t k = 0; k <= kRound + 30; ++k) {
    Keyframe frame = keyframe(k);
    if (k >= kRound) {
      frame.estimate.segment = 1;
      frame.estimate.T_odom_sensor = carried_off * frame.estimate.T_odom_sensor;
    }
    backend.process(frame);
    if (k == kRound + 29) {
      EXPECT_EQ(backend.correction().epoch, 0U);
    }
  }
  const MapCorrection& correction = backend.correction();
  EXPECT_EQ(correction.epoch, 1U);
  const auto moved = [&](std::uint32_t segment, std::uint64_t k, const Pose& T_odom_sensor) {
    const Pose pose = correction.map_pose(segment, 5.0 * static_cast<double>(k), T_odom_sensor);
    return (pose.inverse() * T_odom_sensor).translation_m.norm();
  };
  EXPECT_LT(moved(0, 20, keyframe(20).estimate.T_odom_sensor), 1e-9) << "it holds the map";
  const Pose T_odom_sensor = carried_off * keyframe(kRound + 30).estimate.T_odom_sensor;
  EXPECT_GT(moved(1, kRound + 30, T_odom_sensor), 1.0);
  const Pose here = correction.map_pose(1, 5.0 * (kRound + 30), T_odom_sensor);
  const Pose seen = keyframe(30).estimate.T_odom_sensor;
  EXPECT_LT((here.translation_m - seen.translation_m).norm(), 1e-6);
}

/// What an earlier corridor of the same make would have the keyframe see: 3 m off.
LoopEdge false_loop(std::uint64_t from, std::uint64_t to) {
  const Pose off{Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}};
  return {from, to, true_pose(from).inverse() * (off * true_pose(to)),
          Eigen::Matrix<double, 6, 6>::Identity() * 1e-4};
}

TEST(Backend, LoopsThatFalseOnesKeptOutComeBackAndAreTold) {
  std::map<std::uint64_t, LoopEdge> edges;
  for (std::uint64_t k = 0; k < 3; ++k) edges[kRound + k] = false_loop(k, kRound + k);
  for (std::uint64_t k = 3; k < 9; ++k) edges[kRound + k] = true_loop(k, kRound + k);
  Backend backend({}, {}, {}, known_loops(edges));
  std::map<std::uint64_t, int> accepted;
  std::map<std::uint64_t, int> refused;
  for (std::uint64_t k = 0; k <= kRound + 10; ++k) {
    backend.process(keyframe(k));
    for (const LoopReport& report : backend.loop_reports()) {
      if (report.candidate.to - report.candidate.from != kRound) continue;
      ++(report.candidate.accepted ? accepted : refused)[report.candidate.from];
    }
  }
  EXPECT_EQ(backend.loops_accepted(), 6U);
  EXPECT_EQ(refused[0], 1) << "it was accepted, and then taken out";
  EXPECT_EQ(refused[3], 1) << "at first it stood alone";
  EXPECT_EQ(accepted[3], 1);
  EXPECT_LT(error_m(backend.correction(), kRound + 10), 0.1);
}

/// A second round of which each keyframe shows what one of the first did; `off_m` from where it is.
LoopSource all_seen_before(std::map<std::uint64_t, LoopEdge> edges, double off_m = 0.0) {
  LoopSource source = known_loops(std::move(edges));
  source.search = [search = source.search, off_m](const Keyframe& k) {
    LoopSearch found = search(k);
    if (k.id < kRound) return found;
    Pose T_older_current = true_pose(k.id - kRound).inverse() * true_pose(k.id);
    T_older_current.translation_m.x() += off_m;
    found.seen_before = SeenBefore{k.id - kRound, T_older_current};
    return found;
  };
  return source;
}

TEST(Backend, WhatWasSeenBeforeIsNotKept) {
  std::map<std::uint64_t, LoopEdge> loops;
  for (std::uint64_t k = 0; k < kRound; k += 10) loops[kRound + k] = true_loop(k, kRound + k);
  Backend backend({}, {}, {}, all_seen_before(loops));
  for (std::uint64_t k = 0; k < kRound; ++k) backend.process(keyframe(k));
  backend.process(keyframe(kRound));
  const auto first_round = backend.snapshot();
  for (std::uint64_t k = kRound + 1; k < 2 * kRound; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.snapshot()->point_count, first_round->point_count);
  EXPECT_EQ(backend.loops_accepted(), 6U);
  // The round is 63 m long: a pose in four metres.
  EXPECT_LT(backend.snapshot()->keyframe_count, kRound + kRound / 3);
  EXPECT_GT(backend.snapshot()->keyframe_count, kRound + kRound / 6);
  EXPECT_LT(error_m(backend.correction(), kRound + 5), 0.1);
}

TEST(Backend, WhatIsElsewhereByTheGraphIsKept) {
  Backend backend({}, {}, {}, all_seen_before({{kRound, true_loop(0, kRound)}}, 1.0));
  for (std::uint64_t k = 0; k < 2 * kRound; ++k) backend.process(keyframe(k));
  EXPECT_EQ(backend.snapshot()->keyframe_count, 2 * kRound);
}

class BackendSession : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(directory_); }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::string query(const std::string& sql) const {
    sqlite3* db = nullptr;
    sqlite3_open_v2(file_.c_str(), &db, SQLITE_OPEN_READONLY, nullptr);
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr);
    std::string value;
    if (sqlite3_step(statement) == SQLITE_ROW) {
      value.assign(static_cast<const char*>(sqlite3_column_blob(statement, 0)),
                   static_cast<std::size_t>(sqlite3_column_bytes(statement, 0)));
    }
    sqlite3_finalize(statement);
    sqlite3_close(db);
    return value;
  }

  const std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() / ("glint-backend-" + std::to_string(getpid()));
  const std::filesystem::path file_ = directory_ / "session.glint";
};

TEST_F(BackendSession, TheSessionHasTheLoopItsEventAndTheMovedKeyframes) {
  Backend backend({}, file_, {}, known_loops({{kRound, true_loop(0, kRound)}}));
  for (std::uint64_t k = 0; k <= kRound; ++k) backend.process(keyframe(k));
  backend.finish();
  EXPECT_EQ(backend.store_failures(), 0U) << backend.store_error();
  EXPECT_EQ(backend.keyframes_not_stored(), 0U);
  EXPECT_EQ(query("SELECT count(*) FROM edges WHERE kind='loop'"), "1");
  EXPECT_EQ(query("SELECT count(*) FROM events WHERE kind='loop'"), std::to_string(kRound + 2));
  EXPECT_NE(query("SELECT data FROM events ORDER BY id DESC LIMIT 1").find(R"("accepted":true)"),
            std::string::npos);
  const std::string blob = query("SELECT T_map_sensor FROM keyframes WHERE id=60");
  std::array<double, 7> pose{};
  ASSERT_EQ(blob.size(), sizeof pose);
  std::memcpy(pose.data(), blob.data(), sizeof pose);
  EXPECT_LT(std::hypot(pose[0], pose[1]), 0.02);
}

TEST_F(BackendSession, OfWhatWasSeenBeforeTheSessionHasPosesAlone) {
  std::size_t points = 0;
  {
    Backend backend({}, file_, {}, all_seen_before({{kRound, true_loop(0, kRound)}}));
    for (std::uint64_t k = 0; k < kRound + 10; ++k) backend.process(keyframe(k));
    backend.finish();
    points = backend.snapshot()->point_count;
    EXPECT_LT(backend.snapshot()->keyframe_count, kRound + 5);
    EXPECT_EQ(query("SELECT count(*) FROM clouds WHERE length(points) > 40"),
              std::to_string(kRound + 1))
        << "the first one of the round comes with the loop that tells where it is";
    EXPECT_EQ(query("SELECT count(*) FROM keyframes"),
              std::to_string(backend.snapshot()->keyframe_count));
    EXPECT_EQ(query("SELECT count(*) FROM edges WHERE kind='loop'"), "1");
  }
  // And it is gone on with like any other.
  Backend later({}, {}, {}, known_loops({}), file_);
  later.finish();
  EXPECT_NEAR(static_cast<double>(later.snapshot()->point_count), static_cast<double>(points),
              100.0);
}

}  // namespace
}  // namespace glint::slam
