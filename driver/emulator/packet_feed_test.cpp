// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/packet_feed.hpp"

#include <gtest/gtest.h>

#include "driver/core/bytes.hpp"
#include "driver/core/error.hpp"
#include "driver/core/imu_packet_layout.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::emulator {
namespace {

using glint::test::Bytes;

constexpr SensorTime kBegin{5'000'000'000};

/// Packets from memory.
class MemorySource final : public PacketSource {
 public:
  explicit MemorySource(std::vector<RawPacket> packets) : packets_(std::move(packets)) {}
  SourceStatus read(RawPacket& packet) override {
    if (next_ == packets_.size()) return SourceStatus::kEnd;
    packet = packets_[next_++];
    return SourceStatus::kPacket;
  }
  void stop() override {}

 private:
  std::vector<RawPacket> packets_;
  std::size_t next_ = 0;
};

class LoopedFeedTest : public testing::Test {
 protected:
  /// A capture of scans at 10 Hz from the middle of one to the middle of another, with an IMU
  /// packet every 10 ms.
  void record(int scans, std::uint16_t first_frame_id = 65'534) {
    std::mt19937 random(3);
    std::int64_t index = 0;
    for (int k = 0; k < scans; ++k) {
      LidarScan scan =
          glint::test::random_scan(info_, static_cast<std::uint16_t>(first_frame_id + k), random);
      for (int m = 0; m < info_.columns_per_frame; ++m) {
        scan.column_time[static_cast<std::size_t>(m)] = glint::test::nominal_time(info_, k, m);
      }
      const auto packets = glint::test::encode(info_, scan);
      for (std::size_t i = 0; i < packets.size(); ++i, ++index) {
        const bool outside =
            (k == 0 && i < packets.size() / 2) || (k == scans - 1 && i >= packets.size() / 2);
        const std::int64_t host_ns =
            1'700'000'000'000'000'000 +
            index * 100'000'000 / static_cast<std::int64_t>(packets.size());
        if (index % 4 == 0) add_imu(host_ns, scan.column_time[16 * i]);
        if (!outside) packets_.push_back({{host_ns}, 7502, packets[i]});
      }
    }
  }

  void add_imu(std::int64_t host_ns, SensorTime time) {
    Bytes imu(kLegacyImuPacketBytes);
    store(imu.data() + kLegacyImuAccelTimeOffset, time.ns);
    packets_.push_back({{host_ns}, 7503, imu});
  }

  LoopedCapture capture(std::size_t max_bytes = 1U << 30U) const {
    MemorySource source(packets_);
    return LoopedCapture(source, info_, max_bytes);
  }

  const SensorInfo info_ = glint::test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 16, 512);
  std::vector<RawPacket> packets_;
};

TEST_F(LoopedFeedTest, OnlyWholeScansAreLooped) {
  record(5);
  const LoopedCapture looped = capture();
  EXPECT_EQ(looped.scans(), 3U);
  EXPECT_EQ(looped.lidar_packets(), 3U * 32U);
  EXPECT_EQ(looped.first_frame_id(), 65'535U);
  EXPECT_EQ(looped.first_time(), glint::test::nominal_time(info_, 1, 0));
  EXPECT_EQ(looped.period_ns(), 300'000'000);
  EXPECT_EQ(looped.packets().size(), 3U * (32U + 8U));
}

TEST_F(LoopedFeedTest, LoopsAreOneStreamWithoutAGap) {
  record(5);
  const LoopedCapture looped = capture();
  LoopedFeed feed(looped, 4);
  feed.begin(77, kBegin);
  ScanAssembler assembler(info_);
  FedPacket fed;
  std::int64_t last_due_ns = 0;
  std::uint64_t imu_packets = 0;
  std::vector<std::uint32_t> frame_ids;
  std::vector<std::int64_t> times_ns;
  while (feed.next(fed)) {
    EXPECT_GE(fed.packet.host_time.ns, last_due_ns);
    EXPECT_LT(fed.packet.host_time.ns - last_due_ns, 5'000'000);
    last_due_ns = fed.packet.host_time.ns;
    if (fed.is_imu) {
      const auto time_ns = load<std::int64_t>(fed.packet.bytes.data() + kLegacyImuAccelTimeOffset);
      EXPECT_EQ(time_ns, kBegin.ns + static_cast<std::int64_t>(imu_packets++) * 12'500'000);
      continue;
    }
    static_cast<void>(assembler.push(fed.packet.bytes));
    while (const LidarScan* scan = assembler.next()) {
      frame_ids.push_back(scan->frame_id);
      for (const SensorTime time : scan->column_time) times_ns.push_back(time.ns);
      EXPECT_EQ(scan->columns_received, 512);
    }
  }
  ASSERT_EQ(frame_ids.size(), 12U);
  for (std::uint32_t i = 0; i < 12; ++i) EXPECT_EQ(frame_ids[i], i);
  EXPECT_EQ(times_ns.front(), kBegin.ns);
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(times_ns[i] - times_ns[i - 1]), 1e8 / 512, 1.0) << i;
  }
  EXPECT_EQ(imu_packets, 12U * 8U);
  EXPECT_EQ(assembler.counters().packets, 12U * 32U);
  EXPECT_EQ(assembler.counters().missing_packets, 0U);
  EXPECT_EQ(assembler.counters().restarts, 0U);
}

TEST_F(LoopedFeedTest, ARestartBeginsAnewWithItsOwnInitId) {
  record(3);
  const LoopedCapture looped = capture();
  LoopedFeed feed(looped, 0);
  const PacketFormat format(info_);
  FedPacket fed;
  for (const std::uint32_t init_id : {11U, 12U}) {
    feed.begin(init_id, kBegin);
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(feed.next(fed));
      if (fed.is_imu) continue;
      const auto view = PacketView::parse(format, fed.packet.bytes);
      EXPECT_EQ(view->init_id(), init_id);
      if (i > 1) continue;
      EXPECT_EQ(view->frame_id(), 0U);
      EXPECT_EQ(view->column(0).time(), kBegin);
    }
  }
}

TEST_F(LoopedFeedTest, AClockJumpMovesTimesAndNothingElse) {
  record(3);
  const LoopedCapture looped = capture();
  LoopedFeed steady(looped, 0);
  LoopedFeed jumping(looped, 0);
  steady.begin(1, kBegin);
  jumping.begin(1, kBegin);
  jumping.set_clock_offset(-3'000'000'000);
  FedPacket a;
  FedPacket b;
  do {
    steady.next(a);
    jumping.next(b);
  } while (a.is_imu);
  const PacketFormat format(info_);
  const auto before = PacketView::parse(format, a.packet.bytes);
  const auto after = PacketView::parse(format, b.packet.bytes);
  EXPECT_EQ(after->column(7).time() - before->column(7).time(), -3'000'000'000);
  EXPECT_EQ(after->frame_id(), before->frame_id());
  EXPECT_EQ(a.packet.host_time, b.packet.host_time);
}

TEST_F(LoopedFeedTest, TheLoopEndsWhereTheRecordedSensorRestarted) {
  record(4);
  record(3, 500);  // No loss of packets leaps so far.
  EXPECT_EQ(capture().scans(), 2U);
}

TEST_F(LoopedFeedTest, CapturesThatCannotBeLoopedAreRefused) {
  EXPECT_THROW(capture(), InputError);
  record(3);
  EXPECT_THROW(capture(1000), InputError);
}

}  // namespace
}  // namespace glint::emulator
