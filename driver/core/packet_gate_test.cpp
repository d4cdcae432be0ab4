// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/packet_fields.hpp"
#include "driver/core/test_stream.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::encode;
using test::make_sensor;
using test::random_scan;
using test::Stream;

class PacketGateTest : public test::AssemblerTest {
 protected:
  Bytes imu_packet() const {
    const ImuPacketWriter writer(info);
    const std::vector<ImuSample> samples(static_cast<std::size_t>(writer.format().measurements));
    Bytes packet;
    writer.write(samples, 7, 0, packet);
    return packet;
  }

  // From the manual's offsets.
  Bytes zone_packet() const {
    Bytes packet(680);
    store<std::uint64_t>(packet.data() + 7, std::stoull(info.serial_number));
    store<std::uint32_t>(packet.data() + 3, info.init_id << 8U);
    store<std::uint16_t>(packet.data(), 3);
    store<std::uint16_t>(packet.data() + 2, 7);
    return with_crc(std::move(packet));
  }

  static Bytes with_crc(Bytes packet) {
    store(packet.data() + packet.size() - 8, crc64(std::span(packet).first(packet.size() - 8)));
    return packet;
  }

  // Pushes scans with right CRCs, or with wrong ones as older firmware has them.
  void push_scans(Stream& stream, int count, bool right_crc) {
    for (int k = 0; k < count; ++k) {
      for (Bytes& packet : packets(next_id_++)) {
        if (!right_crc) packet.back() ^= std::byte{1};
        stream.push(packet);
      }
    }
  }

  std::uint32_t next_id_ = 100;
};

TEST_F(PacketGateTest, WhatIsNotTheSensorsIsRejectedAndCounted) {
  Stream stream(info);
  Bytes packet = packets(7)[0];
  EXPECT_EQ(stream.push(Bytes(packet.begin(), packet.end() - 1)), PacketVerdict::kBadSize);
  EXPECT_EQ(stream.push({}), PacketVerdict::kBadSize);
  EXPECT_EQ(stream.push(Bytes(680)), PacketVerdict::kBadType) << "a zone packet's size";
  Bytes other_type = packet;
  store<std::uint16_t>(other_type.data(), 3);
  EXPECT_EQ(stream.push(other_type), PacketVerdict::kBadType);
  info.serial_number = "999";
  EXPECT_EQ(stream.push(packets(7)[0]), PacketVerdict::kForeign);
  EXPECT_EQ(stream.counters().bad_size, 2U);
  EXPECT_EQ(stream.counters().bad_type, 2U);
  EXPECT_EQ(stream.counters().bad_serial, 1U);
  EXPECT_EQ(stream.counters().packets, 0U);
  EXPECT_EQ(stream.counters().datagrams(), 5U);
}

TEST_F(PacketGateTest, ImuAndZonePacketsAreKnown) {
  Stream old(info);
  EXPECT_EQ(old.push(imu_packet()), PacketVerdict::kImu) << "of 48 bytes";
  EXPECT_EQ(old.counters().imu_packets, 1U);
  info.imu_profile = ImuProfile::kAccel32Gyro32Nmea;
  for (const PacketHeader header : {PacketHeader::kStandard, PacketHeader::kFusa}) {
    Stream stream(info);
    info.header = header;
    EXPECT_EQ(stream.push(imu_packet()), PacketVerdict::kImu);
    EXPECT_EQ(stream.push(Bytes(imu_packet().size())), PacketVerdict::kBadType);
    EXPECT_EQ(stream.counters().imu_packets, 1U);
    info.header = PacketHeader::kStandard;
  }
  Stream stream(info);
  EXPECT_EQ(stream.push(zone_packet()), PacketVerdict::kZone);
  EXPECT_EQ(stream.counters().zone_packets, 1U);
  info.serial_number = "999";
  EXPECT_EQ(stream.push(zone_packet()), PacketVerdict::kForeign);
  EXPECT_EQ(stream.push(imu_packet()), PacketVerdict::kForeign);
  EXPECT_EQ(stream.counters().datagrams(), 3U);
}

TEST_F(PacketGateTest, UnknownSerialNumberIsTaken) {
  SensorInfo unsaid = info;
  unsaid.serial_number.clear();
  Stream stream(unsaid);
  stream.push_all(packets(7));
  EXPECT_EQ(stream.scans.size(), 1U);
}

TEST_F(PacketGateTest, AReplacedSensorsPacketsAreTaken) {
  Stream stream(info);
  stream.push_all(packets(7));
  info.serial_number = "999";
  info.init_id += 1;
  stream.assembler.set_identity(info);
  stream.push_all(packets(8));
  EXPECT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.counters().bad_serial, 0U);
}

TEST_F(PacketGateTest, AnotherLayoutsPacketsAreTakenAfterTheChange) {
  Stream stream(info);
  stream.push_all(packets(700));
  info = make_sensor(LidarProfile::kLegacy, 32, 1024);
  stream.assembler.change_sensor(info);
  stream.push_all(packets(3));
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.scans[1].range_mm.rows, 32);
  EXPECT_EQ(stream.scans[1].sequence, 701U);
  EXPECT_TRUE(stream.scans[1].sensor_restarted);
  EXPECT_EQ(stream.counters().packets, 32U + 64U);
}

TEST_F(PacketGateTest, PacketsProveTheHeader) {
  Stream stream(info);
  info.header = PacketHeader::kFusa;
  stream.push_all(packets(70'000));
  ASSERT_EQ(stream.scans.size(), 1U);
  EXPECT_EQ(stream.scans[0].frame_id, 70'000U);
  EXPECT_EQ(stream.assembler.format().frame_id_bits(), 32);
}

TEST_F(PacketGateTest, ReservedCrcOfOldFirmwareRejectsNothing) {
  Stream stream(info);
  push_scans(stream, 10, false);
  EXPECT_EQ(stream.scans.size(), 10U);
  EXPECT_EQ(stream.counters().crc_mismatches, 10U * kPackets);
  EXPECT_EQ(stream.counters().corrupt_packets, 0U);
}

TEST_F(PacketGateTest, DamagedPacketIsRejectedOnceTheStreamsCrcsAreKnownToBeRight) {
  Stream stream(info);
  auto damaged = packets(50)[3];
  damaged[200] ^= std::byte{4};
  EXPECT_EQ(stream.push(damaged), PacketVerdict::kLidar) << "nothing is known yet";
  push_scans(stream, 2, true);
  damaged = packets(next_id_)[3];
  damaged[200] ^= std::byte{4};
  EXPECT_EQ(stream.push(damaged), PacketVerdict::kCorrupt);
  EXPECT_EQ(stream.counters().corrupt_packets, 1U);
  EXPECT_EQ(stream.counters().crc_mismatches, 2U);
}

TEST_F(PacketGateTest, DamagedInitIdIsNoRestartOnceCrcsAreKnownToBeRight) {
  Stream stream(info);
  push_scans(stream, 2, true);
  auto wire = packets(next_id_);
  wire[3][4] ^= std::byte{0x40};
  stream.push_all(wire);
  EXPECT_EQ(stream.counters().restarts, 0U);
  EXPECT_EQ(stream.counters().corrupt_packets, 1U);
}

TEST_F(PacketGateTest, ARunOfMismatchesEndsTheTrust) {
  Stream stream(info);
  push_scans(stream, 4, true);
  push_scans(stream, 10, false);
  EXPECT_EQ(stream.counters().corrupt_packets, CrcTrust::kRun - 1U);
  EXPECT_EQ(stream.scans.size(), 4U + 8U + 1U) << "of the second bad scan, one packet was taken";
  push_scans(stream, 3, true);
  push_scans(stream, 1, false);
  EXPECT_EQ(stream.counters().corrupt_packets, CrcTrust::kRun - 1U + kPackets) << "it comes again";
}

TEST_F(PacketGateTest, OneMismatchAmongMatchesDoesNotEndTheTrust) {
  Stream stream(info);
  push_scans(stream, 4, true);
  for (int k = 0; k < 10; ++k) {
    for (Bytes& packet : packets(next_id_++)) {
      if (random() % 2 == 0) packet.back() ^= std::byte{1};
      stream.push(packet);
    }
  }
  EXPECT_GT(stream.counters().corrupt_packets, 100U);
  EXPECT_EQ(stream.counters().corrupt_packets, stream.counters().crc_mismatches);
}

TEST_F(PacketGateTest, HealthIsThatOfTheLatestPacket) {
  Stream stream(info);
  EXPECT_FALSE(stream.assembler.health());
  Bytes packet = packets(7)[0];
  stream.push(packet);
  ASSERT_TRUE(stream.assembler.health());
  EXPECT_EQ(stream.assembler.health()->alert_flags, 0);
  packet = packets(7)[1];
  store<std::uint8_t>(packet.data() + 12, 0x83);
  store<std::uint32_t>(packet.data() + 16, 0x0301'0705U);
  stream.push(with_crc(packet));
  const PacketHealth health = *stream.assembler.health();
  EXPECT_EQ(health.alert_flags, 0x83);
  EXPECT_EQ(health.thermal_countdown_s, 5);
  EXPECT_EQ(health.shot_limiting_countdown_s, 7);
  EXPECT_EQ(health.thermal_state, 1);
  EXPECT_EQ(health.shot_limiting_state, 3);

  info = make_sensor(LidarProfile::kLegacy, 16, kColumns);
  Stream legacy(info);
  legacy.push_all(packets(7));
  EXPECT_FALSE(legacy.assembler.health()) << "its packets do not say";
}

class DamagedPackets : public testing::TestWithParam<LidarProfile> {};

INSTANTIATE_TEST_SUITE_P(EveryProfile, DamagedPackets, testing::ValuesIn(lidar_profiles()),
                         [](const auto& profile) { return std::string(to_string(profile.param)); });

// Whatever the bytes, nothing is read or written outside and everything is accounted for. Half of
// the streams have CRCs that are not to be believed.
TEST_P(DamagedPackets, AreAccountedFor) {
  std::mt19937 random(7);
  for (const bool has_crc : {false, true}) {
    const SensorInfo info = make_sensor(GetParam(), 16, 512);
    Stream stream(info);
    std::uint64_t pushed = 0;
    for (std::uint32_t id = 0; id < 30; ++id) {
      for (Bytes& packet : encode(info, random_scan(info, id, random))) {
        if (!has_crc) packet.back() ^= std::byte{1};
        const auto flips = id < 4 ? 0 : random() % 4;
        for (unsigned flip = 0; flip < flips; ++flip) {
          packet[random() % std::min<std::size_t>(packet.size(), 300)] ^=
              static_cast<std::byte>(1U << random() % 8);
        }
        if (random() % 50 == 0) packet.resize(random() % packet.size());
        stream.push(packet);
        ++pushed;
      }
    }
    stream.flush();
    const AssemblerCounters& counters = stream.counters();
    EXPECT_EQ(counters.datagrams(), pushed);
    EXPECT_EQ(counters.scans, stream.scans.size());
    EXPECT_TRUE(std::ranges::is_sorted(stream.scans, {}, &LidarScan::sequence));
    EXPECT_EQ(counters.corrupt_packets > 0, has_crc && GetParam() != LidarProfile::kLegacy);
  }
}

}  // namespace
}  // namespace glint
