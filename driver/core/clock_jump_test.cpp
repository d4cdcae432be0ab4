// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Jumps of the sensor's clock cost no scan and are told.
#include <gtest/gtest.h>

#include <algorithm>

#include "driver/core/test_stream.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::encode;
using test::make_sensor;
using test::nominal_time;
using test::Stream;

constexpr int kScans = 12;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

class ClockJumpTest : public test::AssemblerTest {
 protected:
  // Scans 0 to 11; from a column of scan 6 on, the clock is ahead by the jump.
  std::vector<LidarScan> sent_scans(int column, std::int64_t jump_ns) {
    std::vector<LidarScan> scans;
    for (int k = 0; k < kScans; ++k) {
      scans.push_back(scan(static_cast<std::uint32_t>(k)));
      for (int m = 0; m < kColumns; ++m) {
        const bool after = k > 6 || (k == 6 && m >= column);
        scans.back().column_time[static_cast<std::size_t>(m)] =
            nominal_time(info, k, m) + (after ? jump_ns : 0);
      }
    }
    return scans;
  }

  // Every time of a scan is of the clock after the jump.
  void expect_times(const LidarScan& scan, int number, std::int64_t jump_ns) const {
    const std::int64_t rounding_ns = 2;
    for (int m = 0; m < kColumns; ++m) {
      const SensorTime expected = nominal_time(info, number, m) + jump_ns;
      const SensorTime time = scan.column_time[static_cast<std::size_t>(m)];
      ASSERT_LE(std::abs(time - expected), rounding_ns) << "scan " << number << " column " << m;
    }
    EXPECT_LE(std::abs(scan.end_time - (nominal_time(info, number, kColumns - 1) + jump_ns)),
              rounding_ns);
    EXPECT_LE(std::abs(scan.mid_time - (nominal_time(info, number, kColumns / 2) + jump_ns)),
              rounding_ns);
  }

  void expect_no_scan_lost(Stream& stream, const std::vector<LidarScan>& sent,
                           std::int64_t jump_ns) {
    ASSERT_EQ(stream.scans.size(), sent.size());
    for (int k = 0; k < kScans; ++k) {
      const LidarScan& scan = stream.scans[static_cast<std::size_t>(k)];
      EXPECT_EQ(scan.completeness(), 1.0);
      EXPECT_EQ(scan.range_mm.data, sent[static_cast<std::size_t>(k)].range_mm.data);
      EXPECT_EQ(scan.clock_jumped, k == 6) << "scan " << k;
      ASSERT_NO_FATAL_FAILURE(expect_times(scan, k, k >= 6 ? jump_ns : 0));
    }
    const AssemblerCounters& counters = stream.counters();
    EXPECT_EQ(counters.clock_jumps, 1U);
    EXPECT_EQ(counters.packets, kScans * kPackets);
    EXPECT_EQ(counters.missing_packets + counters.restarts + counters.stray_packets, 0U);
  }
};

// The stream begins at 1000 s, so the last jump is that to 1970.
constexpr std::int64_t kJumps_ns[] = {
    3 * kSecond_ns, -3 * kSecond_ns,           3600 * kSecond_ns,
    -60'000'000,    1'700'000'000'000'000'000, -1000 * kSecond_ns};

TEST_F(ClockJumpTest, CostsNoScanAndIsToldOnce) {
  for (const LidarProfile profile : {LidarProfile::kLegacy, LidarProfile::kRng19Rfl8Sig16Nir16}) {
    info = make_sensor(profile, 4, kColumns);
    for (const std::int64_t jump_ns : kJumps_ns) {
      for (const int column : {0, 1, 200, 256, kColumns - 1}) {
        SCOPED_TRACE(std::to_string(jump_ns) + " at column " + std::to_string(column));
        const auto sent = sent_scans(column, jump_ns);
        Stream stream(info);
        for (const LidarScan& scan : sent) stream.push_all(encode(info, scan));
        ASSERT_NO_FATAL_FAILURE(expect_no_scan_lost(stream, sent, jump_ns));
      }
    }
  }
}

TEST_F(ClockJumpTest, IsSeenThroughDisorderAndDuplicates) {
  info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 4, kColumns);
  for (const std::int64_t jump_ns : kJumps_ns) {
    for (const int column : {0, 100, 256, 500}) {
      SCOPED_TRACE(std::to_string(jump_ns) + " at column " + std::to_string(column));
      const auto sent = sent_scans(column, jump_ns);
      std::vector<Bytes> wire;
      for (const LidarScan& scan : sent) {
        for (const Bytes& packet : encode(info, scan)) {
          wire.push_back(packet);
          if (random() % 10 == 0) wire.push_back(packet);
        }
      }
      for (auto at = wire.begin() + 4; wire.end() - at >= 4; at += 4) {
        std::shuffle(at, at + 4, random);
      }
      Stream stream(info);
      stream.push_all(wire);
      ASSERT_NO_FATAL_FAILURE(expect_no_scan_lost(stream, sent, jump_ns));
      EXPECT_EQ(stream.counters().datagrams(), wire.size());
    }
  }
}

TEST_F(ClockJumpTest, JumpOfLessThanHalfAScanPeriodIsNone) {
  const auto sent = sent_scans(256, 40'000'000);
  Stream stream(info);
  for (const LidarScan& scan : sent) stream.push_all(encode(info, scan));
  EXPECT_EQ(stream.counters().clock_jumps, 0U);
  EXPECT_EQ(stream.scans[6].column_time, sent[6].column_time);
}

TEST_F(ClockJumpTest, DamagedTimesAmongGoodOnesAreNone) {
  auto sent = sent_scans(0, 0);
  for (std::size_t m = 100; m < 116; ++m) sent[6].column_time[m] = {77 * kSecond_ns};
  Stream stream(info);
  for (const LidarScan& scan : sent) stream.push_all(encode(info, scan));
  EXPECT_EQ(stream.counters().clock_jumps, 0U);
  EXPECT_EQ(stream.scans[6].column_time, sent[6].column_time);
}

TEST_F(ClockJumpTest, LossAndSilenceAreNone) {
  Stream stream(info);
  stream.push_all(packets(7));
  stream.push_all(packets(12));
  const auto wire = packets(500);
  stream.push_all({wire.begin() + 20, wire.end()});
  stream.flush();
  ASSERT_EQ(stream.scans.size(), 3U);
  EXPECT_EQ(stream.counters().clock_jumps, 0U);
}

// Then neither ids nor times go on; what comes after passes for a new count.
TEST_F(ClockJumpTest, BackwardsInAnOutageCostsTwoPackets) {
  auto sent = sent_scans(0, -900 * kSecond_ns);
  sent[8].frame_id = 300;
  sent[9].frame_id = 301;
  Stream stream(info);
  for (const int k : {4, 5, 8, 9}) stream.push_all(encode(info, sent[static_cast<std::size_t>(k)]));
  EXPECT_EQ(stream.scans.size(), 4U);
  EXPECT_EQ(stream.counters().stray_packets, 2U);
  EXPECT_EQ(stream.counters().packets, 4U * kPackets - 2);
}

TEST_F(ClockJumpTest, RestartedSensorsClockBeginsAnew) {
  Stream stream(info);
  stream.push_all(packets(7000));
  info.init_id += 1;
  stream.push_all(packets(0));
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_FALSE(stream.scans[1].clock_jumped);
  EXPECT_TRUE(stream.scans[1].sensor_restarted);
}

// A sensor that turns at half the rate of its metadata, whole and seen through a window.
TEST_F(ClockJumpTest, OtherRateThanTheMetadatasIsNone) {
  for (const auto& window : {std::pair(0, kColumns - 1), std::pair(128, 383)}) {
    info.column_window = window;
    Stream stream(info);
    for (std::uint32_t k = 0; k < 10; ++k) {
      LidarScan slow = scan(k);
      for (int m = 0; m < kColumns; ++m) {
        const std::int64_t t0 = nominal_time(info, 0, 0).ns;
        slow.column_time[static_cast<std::size_t>(m)].ns =
            t0 + 2 * (nominal_time(info, k, m).ns - t0);
      }
      stream.push_all(encode(info, slow));
    }
    EXPECT_EQ(stream.scans.size(), 10U);
    EXPECT_EQ(stream.counters().clock_jumps, 0U);
  }
}

}  // namespace
}  // namespace glint
