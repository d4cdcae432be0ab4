// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <vector>

namespace glint::daemon {
namespace {

using Queue = BoundedQueue<int>;
using Pop = Queue::PopResult;
using namespace std::chrono_literals;

TEST(BoundedQueueTest, WhenFullTheOldestGoesAndIsCounted) {
  Queue queue(3);
  for (int i = 0; i < 5; ++i) {
    int item = i;
    EXPECT_TRUE(queue.push_drop_oldest(item));
  }
  EXPECT_EQ(queue.dropped(), 2U);
  int item = -1;
  for (int i = 2; i < 5; ++i) {
    ASSERT_EQ(queue.pop(item, 0ms), Pop::kItem);
    EXPECT_EQ(item, i);
  }
  EXPECT_EQ(queue.pop(item, 1ms), Pop::kTimeout);
}

TEST(BoundedQueueTest, TryPushRefusesWhenFullOrClosed) {
  Queue queue(1);
  int item = 1;
  EXPECT_TRUE(queue.try_push(item));
  EXPECT_FALSE(queue.try_push(item));
  ASSERT_EQ(queue.pop(item, 0ms), Pop::kItem);
  queue.close();
  EXPECT_FALSE(queue.try_push(item));
}

TEST(BoundedQueueTest, WhatIsLeftAfterCloseIsStillHandedOut) {
  Queue queue(2);
  int item = 7;
  queue.push_wait(item);
  queue.close();
  EXPECT_FALSE(queue.push_wait(item));
  ASSERT_EQ(queue.pop(item, 0ms), Pop::kItem);
  EXPECT_EQ(item, 7);
  EXPECT_EQ(queue.pop(item, 0ms), Pop::kClosed);
}

TEST(BoundedQueueTest, BuffersAreMadeForTheDepthReachedNotForTheCapacity) {
  BoundedQueue<std::vector<int>> queue(100);
  std::set<const int*> buffers;
  std::vector<int> out;
  std::vector<int> in;
  for (int round = 0; round < 50; ++round) {
    for (int depth = 0; depth < 5; ++depth) {
      in.resize(1000, round);
      buffers.insert(in.data());
      ASSERT_TRUE(queue.push_wait(in));
    }
    for (int depth = 0; depth < 5; ++depth) {
      ASSERT_EQ(queue.pop(out, 0ms), BoundedQueue<std::vector<int>>::PopResult::kItem);
    }
  }
  EXPECT_LE(buffers.size(), 7U) << "five in the queue, one at each side";
}

TEST(BoundedQueueTest, OrderHoldsAcrossDropsAndPops) {
  Queue queue(2);
  for (int i = 0; i < 7; ++i) {
    int item = i;
    queue.push_drop_oldest(item);
    if (i % 3 == 2) queue.pop(item, 0ms);
  }
  int item = -1;
  ASSERT_EQ(queue.pop(item, 0ms), Pop::kItem);
  EXPECT_EQ(item, 5);
  ASSERT_EQ(queue.pop(item, 0ms), Pop::kItem);
  EXPECT_EQ(item, 6);
  EXPECT_EQ(queue.pop(item, 0ms), Pop::kTimeout);
}

TEST(BoundedQueueTest, CloseWakesAWaitingProducerAndAWaitingConsumer) {
  Queue full(1);
  int item = 1;
  full.push_wait(item);
  std::thread producer([&] {
    int more = 2;
    EXPECT_FALSE(full.push_wait(more));
  });
  Queue empty(1);
  std::thread consumer([&] {
    int got = 0;
    EXPECT_EQ(empty.pop(got, 60s), Pop::kClosed);
  });
  full.close();
  empty.close();
  producer.join();
  consumer.join();
}

TEST(BoundedQueueTest, AWaitingProducerLosesNothing) {
  Queue queue(4);
  std::thread producer([&] {
    for (int i = 0; i < 10'000; ++i) {
      int item = i;
      queue.push_wait(item);
    }
    queue.close();
  });
  int item = -1;
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_EQ(queue.pop(item, 60s), Pop::kItem);
    ASSERT_EQ(item, i);
  }
  EXPECT_EQ(queue.pop(item, 60s), Pop::kClosed);
  producer.join();
}

}  // namespace
}  // namespace glint::daemon
