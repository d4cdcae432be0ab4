// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/receive_batch.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <limits>

#include "driver/test_udp.hpp"

namespace glint {
namespace {

using test::payload;
using test::UdpSender;

TEST(DropCount, DifferencesAreRightAcrossTheWrap) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  DropCount count;
  EXPECT_EQ(count.added(3), 3U);
  EXPECT_EQ(count.added(3), 0U);
  EXPECT_EQ(count.added(kMost - 1), kMost - 4);
  EXPECT_EQ(count.added(2), 4U);
}

class ReceiveBatchTest : public testing::Test {
 protected:
  bool send(std::size_t size, int value) {
    return sender_.send(socket_.port(), payload(size, value));
  }
  int receive(ReceiveBatch& batch) { return batch.receive(socket_.get(), {}, counters_); }

  UdpSocket socket_{{}, 0};
  UdpSender sender_;
  ReceiveCounters counters_;
};

TEST_F(ReceiveBatchTest, NothingThereIsSaidWithoutWaiting) {
  ReceiveBatch batch;
  EXPECT_EQ(receive(batch), EAGAIN);
  EXPECT_TRUE(batch.empty());
}

TEST_F(ReceiveBatchTest, OneCallReadsWhatWaits) {
  ReceiveBatch batch;
  const int waiting = ReceiveBatch::kMessages + 3;
  for (int i = 0; i < waiting; ++i) ASSERT_TRUE(send(100, i));
  ASSERT_EQ(receive(batch), 0);
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < ReceiveBatch::kMessages; ++i, batch.take(bytes)) {
    ASSERT_FALSE(batch.empty());
  }
  EXPECT_TRUE(batch.empty());
  ASSERT_EQ(receive(batch), 0);
  batch.take(bytes);
  EXPECT_EQ(bytes, payload(100, ReceiveBatch::kMessages));
}

TEST_F(ReceiveBatchTest, CutDatagramsAreCountedAndNotHandedOut) {
  ReceiveBatch batch(1000);
  ASSERT_TRUE(send(1001, 1));
  ASSERT_TRUE(send(1000, 2));
  ASSERT_TRUE(send(5000, 3));
  ASSERT_EQ(receive(batch), 0);
  std::vector<std::byte> bytes;
  batch.take(bytes);
  EXPECT_EQ(bytes, payload(1000, 2));
  EXPECT_TRUE(batch.empty());
  EXPECT_EQ(counters_.truncated, 2U);
}

TEST_F(ReceiveBatchTest, BuffersGoRoundBySwap) {
  ReceiveBatch batch;
  std::vector<std::byte> bytes;
  // Learns the size, then makes the buffers for it.
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(send(12'608, i));
    ASSERT_EQ(receive(batch), 0);
    batch.take(bytes);
  }
  const std::byte* const given = bytes.data();
  ASSERT_TRUE(send(12'608, 8));
  ASSERT_EQ(receive(batch), 0);
  batch.take(bytes);
  ASSERT_NE(bytes.data(), given) << "copied into the buffer that was given";
  ASSERT_TRUE(send(12'608, 9));
  ASSERT_EQ(receive(batch), 0);
  batch.take(bytes);
  EXPECT_EQ(bytes.data(), given) << "the buffer given is the next to be filled";
  EXPECT_EQ(bytes, payload(12'608, 9));
  EXPECT_LT(bytes.capacity(), 2U * 12'608) << "no buffer is made for the largest datagram of all";
}

}  // namespace
}  // namespace glint
