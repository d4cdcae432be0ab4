// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/pcap_source.hpp"

#include <gmock/gmock.h>

#include <random>

#include "driver/core/error.hpp"
#include "driver/core/test_sensor.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/test_capture.hpp"

namespace glint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr IpAddress kSensorA = IpAddress::v4(10, 0, 0, 1);
constexpr IpAddress kSensorB = IpAddress::v4(10, 0, 0, 2);
constexpr IpAddress kHost = IpAddress::v4(10, 0, 0, 100);

SensorInfo make_sensor(LidarProfile profile, const std::string& serial, int rows = 16) {
  SensorInfo info = test::make_sensor(profile, rows, 512);
  info.serial_number = serial;
  info.lidar_port = 7502;
  info.imu_port = 7503;
  return info;
}

class PcapSourceTest : public ::testing::Test {
 protected:
  /// Writes a scan's packets, 1 ms apart, with an IMU packet after every eighth.
  void write_scan(const SensorInfo& info, const IpAddress& from, std::uint16_t lidar_port = 7502,
                  std::uint16_t imu_port = 7503) {
    const LidarScan scan = test::random_scan(info, 7, random_);
    int count = 0;
    for (const auto& packet : test::encode(info, scan)) {
      write(from, lidar_port, packet);
      if (++count % 8 == 0) write(from, imu_port, test::Bytes(kLegacyImuPacketBytes));
    }
  }
  void write(const IpAddress& from, std::uint16_t port, const test::Bytes& payload) {
    time_ns_ += 1'000'000;
    writer_.write({time_ns_}, {from, 1000}, {kHost, port}, payload);
  }
  PcapSource open(const SensorInfo& info, PcapSourceOptions options = {}) {
    writer_.finish();
    return PcapSource(file_, info, std::move(options));
  }
  std::string complaint(const SensorInfo& info, const PcapSourceOptions& options = {}) {
    try {
      open(info, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }
  /// Reads to the end; the number of packets.
  static std::uint64_t drain(PcapSource& source) {
    RawPacket packet;
    std::uint64_t count = 0;
    while (source.read(packet) == SourceStatus::kPacket) ++count;
    return count;
  }

  std::mt19937 random_{1};
  const test::TempDir dir_;
  const std::filesystem::path file_ = dir_ / "capture.pcap";
  CaptureWriter writer_{file_};
  std::int64_t time_ns_ = 0;
};

TEST_F(PcapSourceTest, LidarAndImuPacketsComeInFileOrder) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  PcapSource source = open(info);
  RawPacket packet;
  std::int64_t last_ns = 0;
  while (source.read(packet) == SourceStatus::kPacket) {
    EXPECT_EQ(packet.port, packet.bytes.size() == kLegacyImuPacketBytes ? 7503 : 7502);
    EXPECT_GT(packet.host_time.ns, last_ns);
    last_ns = packet.host_time.ns;
  }
  EXPECT_EQ(source.counters().lidar_packets, 32U);
  EXPECT_EQ(source.counters().imu_packets, 4U);
  EXPECT_THAT(source.notices(), IsEmpty());
  EXPECT_EQ(source.read(packet), SourceStatus::kEnd);
}

TEST_F(PcapSourceTest, PacketsOnOtherPortsAreFoundAndToldOf) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA, 53750, 53751);
  PcapSource source = open(info);
  EXPECT_EQ(drain(source), 36U);
  EXPECT_THAT(source.notices(),
              ElementsAre(AllOf(HasSubstr("port 53750"), HasSubstr("metadata says 7502")),
                          AllOf(HasSubstr("port 53751"), HasSubstr("metadata says 7503"))));
}

TEST_F(PcapSourceTest, PortOfTheMetadataWinsOverOthers) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorB, 7600, 7601);
  write_scan(info, kSensorB, 7600, 7601);
  write_scan(info, kSensorA);
  PcapSource source = open(info);
  EXPECT_EQ(drain(source), 36U);
  EXPECT_EQ(source.flow().source, kSensorA);
  EXPECT_EQ(source.counters().other_ports, 72U);
  EXPECT_THAT(source.notices(), IsEmpty());
}

TEST_F(PcapSourceTest, SensorOfAnotherSizeOnTheSamePortIsSkippedAndCounted) {
  const SensorInfo small = make_sensor(LidarProfile::kLegacy, "");
  const SensorInfo large = make_sensor(LidarProfile::kLegacy, "", 32);
  write_scan(large, kSensorB);
  write_scan(large, kSensorB);
  write_scan(small, kSensorA);
  PcapSource source = open(small);
  EXPECT_EQ(drain(source), 36U);
  EXPECT_EQ(source.counters().other_sensors, 72U);
  EXPECT_THAT(source.notices(), IsEmpty());
}

TEST_F(PcapSourceTest, SensorOfAnotherSerialIsSkippedEvenFromTheSameAddress) {
  const SensorInfo ours = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "122201000998");
  const SensorInfo other = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "992137000142");
  write_scan(other, kSensorA);
  write_scan(other, kSensorA);
  write_scan(ours, kSensorA);
  PcapSource source = open(ours);
  drain(source);
  EXPECT_EQ(source.counters().lidar_packets, 32U);
  EXPECT_EQ(source.counters().other_sensors, 64U);
}

TEST_F(PcapSourceTest, EqualSensorsAreToldApartByAddress) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  write_scan(info, kSensorB);
  write_scan(info, kSensorB);
  PcapSource most = open(info);
  EXPECT_EQ(drain(most), 72U);
  EXPECT_EQ(most.flow().source, kSensorB);
  EXPECT_THAT(most.notices(), ElementsAre(AllOf(HasSubstr("10.0.0.1"), HasSubstr("--source-ip"))));

  PcapSource picked(file_, info, {kSensorA, {}});
  EXPECT_EQ(drain(picked), 36U);
  EXPECT_EQ(picked.counters().other_sensors, 72U);
  EXPECT_THAT(picked.notices(), IsEmpty());
}

TEST_F(PcapSourceTest, ForeignDatagramsOnTheSensorsPortsAreCounted) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  write(kSensorA, 7502, test::Bytes(100));
  write(kSensorA, 7503, test::Bytes(49));
  write(kSensorA, 9999, test::Bytes(48));
  PcapSource source = open(info);
  EXPECT_EQ(drain(source), 36U);
  EXPECT_EQ(source.counters().wrong_size, 2U);
  EXPECT_EQ(source.counters().other_ports, 1U);
}

TEST_F(PcapSourceTest, MetadataOfAnotherSensorIsRefusedBySize) {
  write_scan(make_sensor(LidarProfile::kLegacy, ""), kSensorA);
  const std::string sentence = complaint(make_sensor(LidarProfile::kLegacy, "", 64));
  EXPECT_THAT(sentence,
              AllOf(HasSubstr("12608 bytes"), HasSubstr("port 7502"), HasSubstr("32 of 3392 bytes"),
                    HasSubstr("(3392 bytes: LEGACY with 16 beams)"), HasSubstr("another sensor"),
                    HasSubstr("--meta")));
}

TEST_F(PcapSourceTest, MetadataOfAnotherSensorIsRefusedBySerial) {
  write_scan(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "122201000998"), kSensorA);
  const std::string sentence =
      complaint(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "992137000142"));
  EXPECT_THAT(sentence, AllOf(HasSubstr("122201000998"), HasSubstr("992137000142")));
}

TEST_F(PcapSourceTest, MetadataOfAnotherStartOrModeIsRefused) {
  const SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "122201000998");
  write_scan(info, kSensorA);
  SensorInfo metadata = info;
  metadata.init_id = 99;
  EXPECT_THAT(complaint(metadata), AllOf(HasSubstr("capture.pcap carry initialization id 7109750"),
                                         HasSubstr("the metadata has 99")));
  metadata = info;
  metadata.columns_per_frame = 256;
  metadata.column_window = {0, 255};
  EXPECT_THAT(complaint(metadata),
              AllOf(HasSubstr("columns up to 511"), HasSubstr("256 columns a scan")));
}

TEST_F(PcapSourceTest, UnknownSourceAddressIsRefused) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  EXPECT_THAT(complaint(info, {kSensorB, {}}),
              AllOf(HasSubstr("from 10.0.0.2"), HasSubstr("--source-ip")));
}

TEST_F(PcapSourceTest, CaptureWithoutRecordsIsRefusedAsEmpty) {
  EXPECT_THAT(complaint(make_sensor(LidarProfile::kLegacy, "")), HasSubstr("is empty"));
}

TEST_F(PcapSourceTest, CaptureWithoutUdpIsRefused) {
  test::PcapBytes capture(test::kLinkEthernet);
  capture.record(0, test::ethernet(test::Buffer(28, 0), 0x0806));
  capture.save(dir_ / "arp.pcap");
  try {
    PcapSource source(dir_ / "arp.pcap", make_sensor(LidarProfile::kLegacy, ""));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("1 of other protocols"));
  }
}

TEST_F(PcapSourceTest, CutCaptureEndsWithANotice) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  writer_.finish();
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 5);
  PcapSource source(file_, info);
  EXPECT_EQ(drain(source), 35U);
  EXPECT_THAT(source.notices(), ElementsAre(HasSubstr("breaks off")));
}

TEST_F(PcapSourceTest, PacketsThatAreNotDueAreHeldBackAndNotLost) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  std::vector<std::int64_t> asked;
  bool due = true;
  const auto every_second_time = [&](HostTime time) {
    asked.push_back(time.ns);
    return due = !due;
  };
  PcapSource source = open(info, {std::nullopt, every_second_time});
  RawPacket packet;
  for (int i = 0; i < 36; ++i) {
    ASSERT_EQ(source.read(packet), SourceStatus::kIdle);
    ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
    EXPECT_EQ(asked[asked.size() - 2], packet.host_time.ns);
    EXPECT_EQ(asked.back(), packet.host_time.ns);
  }
  EXPECT_EQ(source.read(packet), SourceStatus::kEnd);
}

TEST_F(PcapSourceTest, StoppedSourceEnds) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  write_scan(info, kSensorA);
  PcapSource source = open(info);
  source.stop();
  RawPacket packet;
  EXPECT_EQ(source.read(packet), SourceStatus::kEnd);
}

}  // namespace
}  // namespace glint
