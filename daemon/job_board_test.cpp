// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/job_board.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glint::daemon {
namespace {

/// Set by the tests; the clock that they give is a plain function.
std::int64_t job_board_test_now_ns = 0;

class JobBoardTest : public testing::Test {
 protected:
  JobBoardTest() { job_board_test_now_ns = 1'000'000'000; }

  /// What was told since the last call.
  std::vector<Json> told() {
    std::vector<Json> jobs;
    while (const auto event = events_.next(cursor_)) {
      EXPECT_EQ(event->kind, "job");
      jobs.push_back(event->fields["job"]);
    }
    return jobs;
  }
  static void pass_ms(std::int64_t ms) { job_board_test_now_ns += ms * 1'000'000; }

  EventLog events_;
  std::uint64_t cursor_ = 0;
  JobBoard board_{events_, Clock{[] { return job_board_test_now_ns; }}};
};

TEST_F(JobBoardTest, AJobTellsItsBeginItsWayAndItsEnd) {
  const auto job = board_.begin("load_map");
  ASSERT_TRUE(job);
  EXPECT_EQ(told(), (std::vector<Json>{
                        {{"id", 1}, {"kind", "load_map"}, {"state", "running"}, {"progress", 0.0}},
                    }));
  pass_ms(250);
  EXPECT_TRUE(job->progress(0.5));
  EXPECT_EQ(told().at(0)["progress"], 0.5);
  job->done({{"keyframes", 812}});
  EXPECT_EQ(told(), (std::vector<Json>{{{"id", 1},
                                        {"kind", "load_map"},
                                        {"state", "done"},
                                        {"progress", 1.0},
                                        {"result", {{"keyframes", 812}}}}}));
}

TEST_F(JobBoardTest, ProgressIsToldFiveTimesASecondAtMostAndTheEndAlways) {
  const auto job = board_.begin("save_map");
  for (int i = 1; i <= 1000; ++i) {
    pass_ms(1);
    EXPECT_TRUE(job->progress(i / 1000.0));
  }
  EXPECT_EQ(told().size(), 6U) << "the begin, and five in a second";
  job->fail("the disk is full");
  const auto end = told();
  ASSERT_EQ(end.size(), 1U);
  EXPECT_EQ(end[0]["state"], "failed");
  EXPECT_EQ(end[0]["error"], "the disk is full");
  EXPECT_FALSE(end[0].contains("result"));
}

TEST_F(JobBoardTest, ProgressGoesForwardOnlyAndUpToOne) {
  const auto job = board_.begin("save_map");
  static_cast<void>(job->progress(0.6));
  for (const double share : {0.2, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(job->progress(share));
    EXPECT_EQ(board_.running()->progress, 0.6);
  }
  static_cast<void>(job->progress(7.0));
  EXPECT_EQ(board_.running()->progress, 1.0);
}

TEST_F(JobBoardTest, OneRunsAtATime) {
  auto first = board_.begin("save_map");
  EXPECT_FALSE(board_.begin("load_map"));
  EXPECT_EQ(board_.running()->kind, "save_map");
  first->done(Json::object());
  EXPECT_FALSE(board_.running());
  const auto second = board_.begin("load_map");
  ASSERT_TRUE(second);
  EXPECT_EQ(second->report().id, 2U);
  EXPECT_EQ(board_.latest().size(), 2U);
  EXPECT_EQ(board_.latest()[0].kind, "load_map") << "the last begun first";
}

TEST_F(JobBoardTest, AJobEndsOnce) {
  const auto job = board_.begin("save_map");
  job->done({{"name", "a"}});
  const auto other = board_.begin("load_map");
  told();
  job->fail("late");
  job->cancel();
  EXPECT_TRUE(job->progress(0.9));
  EXPECT_TRUE(told().empty());
  EXPECT_EQ(board_.latest()[0].state, JobState::kRunning) << "that of the other one";
  EXPECT_EQ(board_.latest()[1].state, JobState::kDone);
}

TEST_F(JobBoardTest, AJobThatIsDroppedHasFailed) {
  static_cast<void>(board_.begin("load_map"));
  EXPECT_EQ(board_.latest()[0].state, JobState::kFailed);
  EXPECT_FALSE(board_.latest()[0].error.empty());
  EXPECT_TRUE(board_.begin("load_map")) << "it is not in the way of others";
}

TEST_F(JobBoardTest, ClosingGivesUpTheRunningOneAndBeginsNone) {
  auto job = board_.begin("save_map");
  EXPECT_TRUE(job->progress(0.1));
  board_.close();
  EXPECT_FALSE(job->progress(0.2));
  job.reset();
  EXPECT_EQ(board_.latest()[0].state, JobState::kCancelled);
  EXPECT_FALSE(board_.begin("save_map"));
}

TEST_F(JobBoardTest, TheLatestAreRemembered) {
  for (int i = 0; i < 20; ++i) board_.begin("save_map")->done(Json::object());
  const auto latest = board_.latest();
  ASSERT_EQ(latest.size(), JobBoard::kKept);
  EXPECT_EQ(latest.front().id, 20U);
  EXPECT_EQ(latest.back().id, 13U);
}

}  // namespace
}  // namespace glint::daemon
