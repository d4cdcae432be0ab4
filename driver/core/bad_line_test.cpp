// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What comes out of the assembler is what went into the packets, for every profile, header and
// shape of scan, whatever the order within the reorder window, loss and duplication; and every
// packet is accounted for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "driver/core/packet_format.hpp"
#include "driver/core/test_line.hpp"
#include "driver/core/test_stream.hpp"

namespace glint {
namespace {

using test::BadLine;
using test::make_sensor;
using test::same_columns;
using test::Stream;

struct Shape {
  int rows;
  int columns;
  int columns_per_packet;
  std::pair<int, int> window;
  int scans;
};

// Beams, columns and columns per packet over all that sensors have; the last windows touch six,
// two and one packet, and some wrap.
constexpr Shape kShapes[] = {
    {8, 512, 16, {0, 511}, 12},     {16, 1024, 16, {0, 1023}, 3}, {32, 512, 8, {370, 85}, 6},
    {64, 1024, 32, {1, 256}, 2},    {128, 2048, 4, {0, 2047}, 1}, {256, 512, 8, {0, 511}, 1},
    {12, 4096, 64, {4000, 100}, 3}, {20, 640, 1, {0, 639}, 3},    {16, 512, 16, {100, 180}, 20},
    {16, 512, 16, {500, 3}, 20},    {8, 512, 16, {17, 30}, 30},
};

// Scans are given up by the reorder window alone.
constexpr AssemblerOptions kNoTimeout{.timeout_periods = 1000};

std::string describe(const SensorInfo& info) {
  return fmt::format("{} {} {}x{} by {}, window {} to {}", to_string(info.profile),
                     info.header == PacketHeader::kFusa ? "FUSA" : "standard",
                     info.pixels_per_column, info.columns_per_frame, info.columns_per_packet,
                     info.column_window.first, info.column_window.second);
}

void expect_what_was_sent(const BadLine& line, Stream& stream) {
  stream.push_all(line.wire);
  stream.flush();
  ASSERT_EQ(stream.scans.size(), line.scans.size());
  for (std::size_t k = 0; k < line.scans.size(); ++k) {
    ASSERT_EQ(stream.scans[k].frame_id, line.scans[k].frame_id) << k;
    ASSERT_TRUE(same_columns(stream.scans[k], line.scans[k])) << k;
  }
  const AssemblerCounters& counters = stream.counters();
  EXPECT_EQ(counters.datagrams(), line.wire.size());
  EXPECT_EQ(counters.packets, line.arrived);
  // Without an init id, what is very late may as well be of a new count.
  const std::uint64_t strays = stream.assembler.format().legacy() ? counters.stray_packets : 0;
  EXPECT_EQ(counters.late_packets + counters.duplicate_packets + strays, line.doubled);
  EXPECT_EQ(counters.stray_packets, strays);
  EXPECT_EQ(counters.missing_packets, line.never_arrived);
  EXPECT_EQ(counters.scans, line.scans.size());
  EXPECT_EQ(counters.bad_column + counters.clock_jumps + counters.crc_mismatches, 0U);
}

class EveryProfile : public testing::TestWithParam<LidarProfile> {};

INSTANTIATE_TEST_SUITE_P(All, EveryProfile, testing::ValuesIn(lidar_profiles()),
                         [](const auto& profile) { return std::string(to_string(profile.param)); });

std::vector<PacketHeader> headers_of(LidarProfile profile) {
  if (profile == LidarProfile::kLegacy) return {PacketHeader::kStandard};
  if (profile == LidarProfile::kFusaRng15Rfl8Nir8Dual) return {PacketHeader::kFusa};
  return {PacketHeader::kStandard, PacketHeader::kFusa};
}

// Frame ids wrap in the middle.
std::uint32_t first_frame_id(const SensorInfo& info, int scans) {
  const std::uint32_t before = static_cast<std::uint32_t>(scans) / 2;
  return PacketFormat(info).frame_id_bits() == 16 ? 65'536U - before : 0U - before;
}

TEST_P(EveryProfile, ScansOfEveryShapeSurviveABadLine) {
  std::uint32_t seed = 1;
  for (const Shape& shape : kShapes) {
    for (const PacketHeader header : headers_of(GetParam())) {
      SensorInfo info = make_sensor(GetParam(), shape.rows, shape.columns);
      info.columns_per_packet = shape.columns_per_packet;
      info.column_window = shape.window;
      info.header = header;
      SCOPED_TRACE(describe(info));
      BadLine line(info, {.loss = 0.02, .doubled = 0.02}, seed++);
      line.run(shape.scans, first_frame_id(info, shape.scans));
      Stream stream(info, kNoTimeout);
      ASSERT_NO_FATAL_FAILURE(expect_what_was_sent(line, stream));
      EXPECT_EQ(stream.counters().restarts, 0U);
    }
  }
}

// Small scans and much harm: whole scans are lost as well, and the line is dead for a while.
TEST_P(EveryProfile, EveryPacketIsAccountedForOnAVeryBadLine) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    SensorInfo info = make_sensor(GetParam(), 4, 128);
    if (seed % 3 == 1) info.column_window = {30, 70};
    if (seed % 3 == 2) info.column_window = {120, 20};
    SCOPED_TRACE(fmt::format("{}, seed {}", describe(info), seed));
    BadLine line(info, {.loss = 0.3, .doubled = 0.1}, seed);
    line.outage(static_cast<int>(seed) * 3);
    line.run(60, first_frame_id(info, 60));
    Stream stream(info, kNoTimeout);
    ASSERT_NO_FATAL_FAILURE(expect_what_was_sent(line, stream));
    EXPECT_EQ(stream.counters().restarts, 0U);
  }
}

TEST_P(EveryProfile, EveryPacketIsAccountedForOverRestarts) {
  if (GetParam() == LidarProfile::kLegacy) GTEST_SKIP() << "its packets do not tell of restarts";
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const SensorInfo info = make_sensor(GetParam(), 4, 256);
    SCOPED_TRACE(seed);
    BadLine line(info, {.loss = 0.05, .doubled = 0.05}, seed);
    for (int k = 0; k < 5; ++k) {
      line.run(6, k == 0 ? 4711 : 0, true);
      line.restart();
    }
    Stream stream(info, kNoTimeout);
    ASSERT_NO_FATAL_FAILURE(expect_what_was_sent(line, stream));
    EXPECT_EQ(stream.counters().restarts, 4U);
    EXPECT_EQ(std::ranges::count(stream.scans, true, &LidarScan::sensor_restarted), 4);
    for (std::size_t k = 1; k < stream.scans.size(); ++k) {
      EXPECT_EQ(stream.scans[k].sequence, stream.scans[k - 1].sequence + 1);
    }
  }
}

}  // namespace
}  // namespace glint
