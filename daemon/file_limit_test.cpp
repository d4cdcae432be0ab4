// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/file_limit.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace glint::daemon {
namespace {

class FileLimitTest : public testing::Test {
 protected:
  FileLimitTest() { getrlimit(RLIMIT_NOFILE, &before_); }
  ~FileLimitTest() override { setrlimit(RLIMIT_NOFILE, &before_); }

  static rlim_t now() {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    return limit.rlim_cur;
  }

  rlimit before_{};
};

TEST_F(FileLimitTest, IsRaisedAsFarAsItMayBeAndNeverLowered) {
  const rlimit low{64, before_.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &low), 0);
  ASSERT_GE(before_.rlim_max, 256U);
  EXPECT_EQ(raise_file_limit(200), 200U);
  EXPECT_EQ(now(), 200U);
  EXPECT_EQ(raise_file_limit(100), 200U);
  EXPECT_EQ(now(), 200U);
  EXPECT_EQ(raise_file_limit(before_.rlim_max + 1), before_.rlim_max);
}

}  // namespace
}  // namespace glint::daemon
