// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/scan_assembler.hpp"

#include <gtest/gtest.h>

#include "driver/core/bytes.hpp"
#include "driver/core/test_stream.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::clear_columns;
using test::encode;
using test::nominal_time;
using test::same_columns;
using test::Stream;

class ScanAssemblerTest : public test::AssemblerTest {};

TEST_F(ScanAssemblerTest, ScanLeavesWithItsLastPacket) {
  Stream stream(info);
  const auto wire = packets(7);
  for (int i = 0; i + 1 < kPackets; ++i) stream.push(wire[static_cast<std::size_t>(i)]);
  EXPECT_TRUE(stream.scans.empty());
  stream.push(wire.back());
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].columns_received, kColumns);
  EXPECT_DOUBLE_EQ(stream.scans[0].completeness(), 1.0);
  EXPECT_EQ(stream.scans[0].end_time, nominal_time(info, 7, kColumns - 1));
  EXPECT_EQ(stream.scans[0].mid_time, nominal_time(info, 7, kColumns / 2));
}

TEST_F(ScanAssemblerTest, IncompleteScanLeavesAfterTheReorderWindow) {
  Stream stream(info, {.reorder_window_packets = 4});
  auto first = packets(7);
  const Bytes straggler = first[10];
  first.erase(first.begin() + 10);
  stream.push_all(first);
  const auto second = packets(8);
  stream.push_all({second.begin(), second.begin() + 3});
  EXPECT_TRUE(stream.scans.empty());
  stream.push(second[3]);
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].columns_received, kColumns - 16);
  EXPECT_EQ(stream.counters().missing_packets, 1U);
  EXPECT_EQ(stream.counters().incomplete_scans, 1U);
  stream.push(straggler);
  EXPECT_EQ(stream.counters().late_packets, 1U);
}

TEST_F(ScanAssemblerTest, CompleteScanWaitsForAnOlderOne) {
  Stream stream(info, {.reorder_window_packets = 1000, .timeout_periods = 1000});
  const auto first = packets(7);
  stream.push_all({first.begin(), first.end() - 1});
  stream.push_all(packets(8));
  EXPECT_TRUE(stream.scans.empty());
  stream.push(first.back());
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.scans[0].frame_id, 7);
  EXPECT_EQ(stream.scans[1].frame_id, 8);
  EXPECT_EQ(stream.counters().incomplete_scans, 0U);
}

TEST_F(ScanAssemblerTest, AtMostFourScansStayOpen) {
  Stream stream(info, {.reorder_window_packets = 1000, .timeout_periods = 1000});
  for (std::uint32_t id = 0; id < 6; ++id) stream.push(packets(id)[0]);
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.scans[0].frame_id, 0);
  EXPECT_EQ(stream.scans[1].frame_id, 1);
}

TEST_F(ScanAssemblerTest, IncompleteScanLeavesWhenNewerOnesAreFarOn) {
  Stream stream(info, {.reorder_window_packets = 1000, .timeout_periods = 1.5});
  stream.push(packets(7)[0]);
  stream.push(packets(8)[0]);
  EXPECT_TRUE(stream.scans.empty());
  stream.push(packets(9)[0]);
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].frame_id, 7);
}

TEST_F(ScanAssemblerTest, LostColumnsDoNotMoveTheScansTimes) {
  Stream stream(info);
  const auto wire = packets(7);
  // The last quarter never came, and a piece about the middle.
  stream.push_all({wire.begin(), wire.begin() + 14});
  stream.push_all({wire.begin() + 18, wire.begin() + 24});
  stream.flush();
  const std::int64_t tolerance_ns = 100;  // rounding of nominal column times
  EXPECT_NEAR(static_cast<double>(stream.scans[0].end_time - nominal_time(info, 7, kColumns - 1)),
              0, tolerance_ns);
  EXPECT_NEAR(static_cast<double>(stream.scans[0].mid_time - nominal_time(info, 7, kColumns / 2)),
              0, tolerance_ns);
}

TEST_F(ScanAssemblerTest, TimesOfAScanOfOnePacketAreExtrapolatedAtTheNominalRate) {
  Stream stream(info);
  LidarScan jittered = scan(7);
  jittered.column_time[15] = jittered.column_time[15] + 50'000;  // a quarter of a column late
  stream.push(encode(info, jittered)[0]);
  stream.flush();
  EXPECT_NEAR(static_cast<double>(stream.scans[0].end_time - nominal_time(info, 7, kColumns - 1)),
              0, 60'000);
}

TEST_F(ScanAssemblerTest, WindowedScanIsCompleteWithItsWindow) {
  info.column_window = {1, 256};
  Stream stream(info);
  LidarScan sent = scan(7);
  sent.column_status[0] = 0;
  for (std::size_t m = 257; m < kColumns; ++m) sent.column_status[m] = 0;
  const auto wire = encode(info, sent);
  stream.push_all({wire.begin(), wire.begin() + 17});
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].columns_expected, 256);
  EXPECT_EQ(stream.scans[0].columns_received, 256);
  EXPECT_EQ(stream.scans[0].end_time, nominal_time(info, 7, 256));
  EXPECT_EQ(stream.scans[0].mid_time, nominal_time(info, 7, 129));
  EXPECT_EQ(stream.counters().missing_packets, 0U);
  clear_columns(sent, 0, 1);
  clear_columns(sent, 257, kColumns);
  EXPECT_TRUE(same_columns(stream.scans[0], sent));
}

TEST_F(ScanAssemblerTest, WrappedWindowEndsAtTheLastColumnOfTheTurn) {
  info.column_window = {370, 85};
  Stream stream(info);
  const auto wire = packets(7);
  stream.push_all({wire.begin(), wire.begin() + 6});
  stream.push_all({wire.begin() + 23, wire.end() - 1});
  EXPECT_TRUE(stream.scans.empty());
  stream.push(wire.back());
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].columns_expected, 228);
  EXPECT_EQ(stream.scans[0].end_time, nominal_time(info, 7, kColumns - 1));
  stream.push(packets(8)[10]);
  EXPECT_EQ(stream.counters().packets, 16U) << "packets outside the window are taken and ignored";
  stream.flush();
  EXPECT_EQ(stream.scans.size(), 1U);
}

TEST_F(ScanAssemblerTest, InvalidColumnsCountAsReceivedByNobodyButDoNotHoldUpTheScan) {
  Stream stream(info);
  LidarScan sent = scan(7);
  sent.column_status[100] = 0;
  stream.push_all(encode(info, sent));
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].columns_received, kColumns - 1);
  clear_columns(sent, 100, 101);
  EXPECT_TRUE(same_columns(stream.scans[0], sent));
}

TEST_F(ScanAssemblerTest, ReusedBuffersHoldNothingOfEarlierScans) {
  Stream stream(info);
  for (std::uint32_t id = 0; id < 30; ++id) stream.push_all(packets(id));
  LidarScan sent = scan(30);
  const auto wire = encode(info, sent);
  stream.push(wire[4]);
  stream.flush();
  clear_columns(sent, 0, 64);
  clear_columns(sent, 80, kColumns);
  EXPECT_TRUE(same_columns(stream.scans.back(), sent));
  EXPECT_FALSE(stream.scans.back().sensor_restarted);
}

TEST_F(ScanAssemblerTest, ColumnsBeyondTheScanAreDroppedAndCounted) {
  Stream stream(info);
  LidarScan sent = scan(7);
  auto wire = encode(info, sent);
  const std::size_t column_bytes = PacketFormat(info).column_bytes;
  store<std::uint16_t>(wire[0].data() + 32 + 2 * column_bytes + 8, kColumns);
  stream.push_all(wire);
  stream.flush();
  EXPECT_EQ(stream.counters().bad_column, 1U);
  clear_columns(sent, 2, 3);
  EXPECT_TRUE(same_columns(stream.scans[0], sent));
}

TEST_F(ScanAssemblerTest, ScansNobodyTakesAreKeptForAWhileAndThenCounted) {
  ScanAssembler assembler(info);
  for (std::uint32_t id = 0; id < 9; ++id) {
    for (const Bytes& packet : packets(id)) assembler.push(packet);
  }
  EXPECT_EQ(assembler.counters().untaken_scans, 4U);
  const LidarScan* oldest = assembler.next();
  ASSERT_NE(oldest, nullptr);
  EXPECT_EQ(oldest->frame_id, 4);
}

}  // namespace
}  // namespace glint
