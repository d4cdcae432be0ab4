// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/metadata_check.hpp"

#include <gmock/gmock.h>

#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// What so many scans of a sensor prove.
PacketEvidence evidence_of(const SensorInfo& info, int scans) {
  const PacketFormat format(info);
  std::mt19937 random(1);
  PacketEvidence evidence;
  for (int i = 0; i < scans; ++i) {
    const LidarScan scan = test::random_scan(info, static_cast<std::uint16_t>(i), random);
    for (const test::Bytes& packet : test::encode(info, scan)) {
      evidence.add(*PacketView::parse(format, packet));
    }
  }
  return evidence;
}

class MetadataCheck : public testing::TestWithParam<LidarProfile> {
 protected:
  [[nodiscard]] std::string contradiction(const SensorInfo& metadata, int scans = 6) const {
    return metadata_contradiction(metadata, evidence_of(info_, scans), "Packets");
  }
  const SensorInfo info_ = test::make_sensor(GetParam(), 2, 256);
};

TEST_P(MetadataCheck, OwnMetadataIsNotContradicted) {
  EXPECT_THAT(contradiction(info_), IsEmpty());
  EXPECT_THAT(contradiction(info_, 0), IsEmpty());
}

TEST_P(MetadataCheck, OtherNumberOfColumnsIsToldWithBothValues) {
  SensorInfo metadata = info_;
  metadata.columns_per_frame = 128;
  metadata.column_window = {0, 127};
  EXPECT_THAT(contradiction(metadata, 1),
              AllOf(HasSubstr("up to 255"), HasSubstr("128 columns a scan")));
  metadata.columns_per_frame = 512;
  metadata.column_window = {0, 511};
  EXPECT_THAT(contradiction(metadata),
              AllOf(HasSubstr("up to 255"), HasSubstr("512 columns a scan"), HasSubstr("at 511")));
  // The rest of a scan or two may have been lost.
  EXPECT_THAT(contradiction(metadata, 2), IsEmpty());
}

TEST_P(MetadataCheck, WindowNeedsNoColumnsBeyondIt) {
  SensorInfo metadata = info_;
  metadata.columns_per_frame = 512;
  metadata.column_window = {10, 250};
  EXPECT_THAT(contradiction(metadata), IsEmpty());
  metadata.column_window = {250, 10};  // Wraps, so it has the last column.
  EXPECT_THAT(contradiction(metadata), HasSubstr("ends at 511"));
}

INSTANTIATE_TEST_SUITE_P(Profiles, MetadataCheck,
                         testing::Values(LidarProfile::kLegacy, LidarProfile::kRng15Rfl8Nir8,
                                         LidarProfile::kFusaRng15Rfl8Nir8Dual));

TEST(MetadataCheckIds, OtherSensorAndOtherStartAreToldWithBothValues) {
  const SensorInfo info = test::make_sensor(LidarProfile::kRng15Rfl8Nir8, 2, 256);
  const PacketEvidence evidence = evidence_of(info, 1);
  SensorInfo metadata = info;
  metadata.serial_number = "122201000999";
  EXPECT_THAT(metadata_contradiction(metadata, evidence, "Packets of drive.pcap"),
              AllOf(StartsWith("Packets of drive.pcap"), HasSubstr("sensor 122201000998"),
                    HasSubstr("sensor 122201000999"), HasSubstr("give the metadata")));
  metadata = info;
  metadata.init_id = 5;
  EXPECT_THAT(metadata_contradiction(metadata, evidence, "Packets"),
              AllOf(HasSubstr("id 7109750"), HasSubstr("has 5"), HasSubstr("initialization_id")));
  // What is not known contradicts nothing.
  metadata.init_id = 0;
  metadata.serial_number.clear();
  EXPECT_THAT(metadata_contradiction(metadata, evidence, "Packets"), IsEmpty());
}

TEST(MetadataCheckIds, RestartWithinTheStreamIsNoOtherStart) {
  SensorInfo info = test::make_sensor(LidarProfile::kRng15Rfl8Nir8, 2, 256);
  PacketEvidence evidence = evidence_of(info, 1);
  SensorInfo restarted = info;
  restarted.init_id = 8;
  std::mt19937 random(1);
  const auto packets = test::encode(restarted, test::random_scan(restarted, 0, random));
  evidence.add(*PacketView::parse(PacketFormat(info), packets.front()));
  EXPECT_THAT(metadata_contradiction(info, evidence, "Packets"), IsEmpty());
  EXPECT_THAT(metadata_contradiction(restarted, evidence, "Packets"), IsEmpty());
}

TEST(MetadataCheckIds, DamagedPacketsProveNothing) {
  const SensorInfo info = test::make_sensor(LidarProfile::kLegacy, 2, 256);
  const PacketFormat format(info);
  PacketEvidence evidence;
  std::mt19937 random(1);
  test::Bytes packet(format.packet_bytes);
  for (int i = 0; i < 1000; ++i) {
    for (std::byte& byte : packet) byte = static_cast<std::byte>(random());
    evidence.add(*PacketView::parse(format, packet));
  }
  EXPECT_THAT(metadata_contradiction(info, evidence, "Packets"), IsEmpty());
}

}  // namespace
}  // namespace glint
