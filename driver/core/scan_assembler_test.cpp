// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/scan_assembler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "driver/core/bytes.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::clear_columns;
using test::encode;
using test::make_sensor;
using test::nominal_time;
using test::random_scan;
using test::same_columns;

constexpr int kColumns = 512;
constexpr int kPackets = kColumns / 16;

// A stream of one sensor into an assembler; what leaves is kept.
class Stream {
 public:
  explicit Stream(const SensorInfo& info, AssemblerOptions options = {})
      : assembler(info, options) {}

  PacketError push(const Bytes& packet) {
    const PacketError error = assembler.push(packet);
    collect();
    return error;
  }
  void push_all(std::span<const Bytes> packets) {
    for (const Bytes& packet : packets) push(packet);
  }
  void flush() {
    assembler.flush();
    collect();
  }
  const AssemblerCounters& counters() const { return assembler.counters(); }

  ScanAssembler assembler;
  std::vector<LidarScan> scans;

 private:
  void collect() {
    while (const LidarScan* scan = assembler.next()) scans.push_back(*scan);
  }
};

class ScanAssemblerTest : public testing::Test {
 protected:
  LidarScan scan(std::uint16_t frame_id) { return random_scan(info, frame_id, random); }
  std::vector<Bytes> packets(std::uint16_t frame_id) { return encode(info, scan(frame_id)); }

  SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 16, kColumns);
  std::mt19937 random{5};
};

class EveryProfile : public testing::TestWithParam<LidarProfile> {};

INSTANTIATE_TEST_SUITE_P(All, EveryProfile,
                         testing::Values(LidarProfile::kLegacy, LidarProfile::kRng19Rfl8Sig16Nir16,
                                         LidarProfile::kRng19Rfl8Sig16Nir16Dual,
                                         LidarProfile::kRng15Rfl8Nir8),
                         [](const auto& profile) { return std::string(to_string(profile.param)); });

// A sensor behind a bad network: random scans across the wrap of the frame id, some packets lost,
// some doubled, and all permuted within the reorder window.
struct BadNetwork {
  static constexpr int kScans = 12;
  static constexpr int kFirstId = 65'530;

  BadNetwork(const SensorInfo& info, std::mt19937& random) {
    for (int k = 0; k < kScans; ++k) {
      scans.push_back(random_scan(info, static_cast<std::uint16_t>(kFirstId + k), random));
      for (int m = 0; m < kColumns; ++m) {
        scans.back().column_time[static_cast<std::size_t>(m)] = nominal_time(info, k, m);
      }
      send(encode(info, scans.back()), random);
    }
    for (auto at = wire.begin(); at != wire.end();) {
      const auto end = at + std::min<std::ptrdiff_t>(4, wire.end() - at);
      std::shuffle(at, end, random);
      at = end;
    }
  }

  void send(const std::vector<Bytes>& packets, std::mt19937& random) {
    for (int i = 0; i < kPackets; ++i) {
      const auto chance = random() % 50;
      if (chance == 0) {
        clear_columns(scans.back(), 16 * i, 16 * i + 16);
        ++lost;
        continue;
      }
      wire.push_back(packets[static_cast<std::size_t>(i)]);
      if (chance != 1) continue;
      wire.push_back(wire.back());
      ++doubled;
    }
  }

  std::vector<LidarScan> scans;  // without what was lost
  std::vector<Bytes> wire;
  std::uint64_t lost = 0;
  std::uint64_t doubled = 0;
};

// What comes out is what went in, and every packet is accounted for.
TEST_P(EveryProfile, ScansSurvivePermutationDuplicationAndLoss) {
  const SensorInfo info = make_sensor(GetParam(), 16, kColumns);
  std::mt19937 random(6);
  for (int round = 0; round < 20; ++round) {
    const BadNetwork sent(info, random);
    Stream stream(info);
    stream.push_all(sent.wire);
    stream.flush();
    ASSERT_EQ(stream.scans.size(), sent.scans.size());
    for (std::size_t k = 0; k < sent.scans.size(); ++k) {
      EXPECT_EQ(stream.scans[k].frame_id, sent.scans[k].frame_id);
      EXPECT_EQ(stream.scans[k].sequence, BadNetwork::kFirstId + k) << "this does not wrap";
      EXPECT_TRUE(same_columns(stream.scans[k], sent.scans[k])) << k << " of round " << round;
    }
    const AssemblerCounters& counters = stream.counters();
    EXPECT_EQ(counters.packets, sent.scans.size() * kPackets - sent.lost);
    EXPECT_EQ(counters.missing_packets, sent.lost);
    EXPECT_EQ(counters.late_packets + counters.duplicate_packets, sent.doubled);
    EXPECT_EQ(counters.scans, sent.scans.size());
    EXPECT_EQ(counters.restarts + counters.stray_packets + counters.bad_column, 0U);
  }
}

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
  for (std::uint16_t id = 0; id < 6; ++id) stream.push(packets(id)[0]);
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.scans[0].frame_id, 0);
  EXPECT_EQ(stream.scans[1].frame_id, 1);
}

TEST_F(ScanAssemblerTest, IncompleteScanLeavesByPacketTime) {
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
  for (std::uint16_t id = 0; id < 30; ++id) stream.push_all(packets(id));
  LidarScan sent = scan(30);
  const auto wire = encode(info, sent);
  stream.push(wire[4]);
  stream.flush();
  clear_columns(sent, 0, 64);
  clear_columns(sent, 80, kColumns);
  EXPECT_TRUE(same_columns(stream.scans.back(), sent));
  EXPECT_FALSE(stream.scans.back().sensor_restarted);
}

TEST_F(ScanAssemblerTest, RestartWithANewInitIdBeginsANewNumbering) {
  Stream stream(info);
  const auto before = packets(700);
  stream.push_all(packets(699));
  stream.push_all({before.begin(), before.begin() + 5});
  info.init_id += 1;
  stream.push_all(packets(0));
  ASSERT_EQ(stream.scans.size(), 3U);
  EXPECT_EQ(stream.scans[1].columns_received, 80) << "the open scan leaves as it is";
  EXPECT_FALSE(stream.scans[1].sensor_restarted);
  EXPECT_TRUE(stream.scans[2].sensor_restarted);
  EXPECT_EQ(stream.scans[2].frame_id, 0);
  EXPECT_EQ(stream.scans[2].sequence, 701U);
  EXPECT_EQ(stream.counters().restarts, 1U);
  stream.push(before[6]);
  EXPECT_EQ(stream.counters().late_packets, 1U) << "overtaken by the restart";
  stream.push_all(packets(1));
  EXPECT_EQ(stream.scans.back().sequence, 702U);
  EXPECT_FALSE(stream.scans.back().sensor_restarted);
}

TEST_F(ScanAssemblerTest, MetadataOfAnotherInitIdIsNoRestart) {
  Stream stream(info);
  info.init_id += 1;
  stream.push_all(packets(3));
  EXPECT_EQ(stream.counters().restarts, 0U);
  EXPECT_EQ(stream.scans.size(), 1U);
}

TEST_F(ScanAssemblerTest, LegacyRestartLosesOneScanAndNotTheStream) {
  info = make_sensor(LidarProfile::kLegacy, 16, kColumns);
  Stream stream(info);
  stream.push_all(packets(9000));
  for (std::uint16_t id = 10; id < 15; ++id) stream.push_all(packets(id));
  ASSERT_EQ(stream.scans.size(), 5U);
  EXPECT_EQ(stream.counters().late_packets, kPackets);
  EXPECT_EQ(stream.counters().restarts, 1U);
  EXPECT_EQ(stream.scans[1].frame_id, 11);
  EXPECT_EQ(stream.scans[1].sequence, 9001U);
  EXPECT_TRUE(stream.scans[1].sensor_restarted);
}

TEST_F(ScanAssemblerTest, DamagedFrameIdDoesNotMakeTheRestLate) {
  Stream stream(info);
  auto wire = packets(7);
  store<std::uint16_t>(wire[3].data() + 2, 20'007);
  stream.push_all(wire);
  for (std::uint16_t id = 8; id < 11; ++id) stream.push_all(packets(id));
  EXPECT_EQ(stream.scans.size(), 4U);
  EXPECT_EQ(stream.counters().stray_packets, 1U);
  EXPECT_EQ(stream.counters().late_packets, 0U);
}

TEST_F(ScanAssemblerTest, StreamGoesOnAfterALongSilence) {
  Stream stream(info);
  stream.push_all(packets(7));
  stream.push_all(packets(7000));
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.scans[1].sequence, 7000U);
  EXPECT_EQ(stream.counters().stray_packets, 0U);
}

TEST_F(ScanAssemblerTest, WhatIsNotTheSensorsIsRejectedAndCounted) {
  Stream stream(info);
  Bytes packet = packets(7)[0];
  EXPECT_EQ(stream.push(Bytes(packet.begin(), packet.end() - 1)), PacketError::kSize);
  EXPECT_EQ(stream.push(Bytes(48)), PacketError::kSize);
  Bytes zones = packet;
  store<std::uint16_t>(zones.data(), 3);
  EXPECT_EQ(stream.push(zones), PacketError::kType);
  info.serial_number = "999";
  EXPECT_EQ(stream.push(packets(7)[0]), PacketError::kSerial);
  EXPECT_EQ(stream.counters().bad_size, 2U);
  EXPECT_EQ(stream.counters().bad_type, 1U);
  EXPECT_EQ(stream.counters().bad_serial, 1U);
  EXPECT_EQ(stream.counters().packets, 0U);
}

TEST_F(ScanAssemblerTest, UnknownSerialNumberIsTaken) {
  SensorInfo unsaid = info;
  unsaid.serial_number.clear();
  Stream stream(unsaid);
  stream.push_all(packets(7));
  EXPECT_EQ(stream.scans.size(), 1U);
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

// Whatever the bytes, nothing is read or written outside and everything is accounted for.
TEST_P(EveryProfile, DamagedPacketsAreAccountedFor) {
  const SensorInfo info = make_sensor(GetParam(), 16, kColumns);
  std::mt19937 random(7);
  Stream stream(info);
  std::uint64_t pushed = 0;
  for (std::uint16_t id = 0; id < 40; ++id) {
    for (Bytes& packet : encode(info, random_scan(info, id, random))) {
      const auto flips = random() % 4;
      for (unsigned flip = 0; flip < flips; ++flip) {
        packet[random() % std::min<std::size_t>(packet.size(), 300)] ^=
            static_cast<std::byte>(1U << random() % 8);
      }
      stream.push(packet);
      ++pushed;
    }
  }
  stream.flush();
  const AssemblerCounters& c = stream.counters();
  EXPECT_EQ(c.packets + c.bad_size + c.bad_type + c.bad_serial + c.late_packets + c.stray_packets +
                c.duplicate_packets,
            pushed);
  EXPECT_EQ(c.scans, stream.scans.size());
  EXPECT_TRUE(std::ranges::is_sorted(stream.scans, {}, &LidarScan::sequence));
}

TEST_F(ScanAssemblerTest, ScansNobodyTakesAreKeptForAWhileAndThenCounted) {
  ScanAssembler assembler(info);
  for (std::uint16_t id = 0; id < 9; ++id) {
    for (const Bytes& packet : packets(id)) assembler.push(packet);
  }
  EXPECT_EQ(assembler.counters().untaken_scans, 4U);
  const LidarScan* oldest = assembler.next();
  ASSERT_NE(oldest, nullptr);
  EXPECT_EQ(oldest->frame_id, 4);
}

}  // namespace
}  // namespace glint
