// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/recording_source.hpp"

#include <gmock/gmock.h>

#include <random>

#include "driver/core/error.hpp"
#include "driver/core/test_sensor.hpp"
#include "pcap/recording/test_recording.hpp"
#include "pcap/test_capture.hpp"

namespace glint::recording {
namespace {

using test::TestMessage;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SensorInfo make_sensor(LidarProfile profile, const std::string& serial, int rows = 16) {
  SensorInfo info = glint::test::make_sensor(profile, rows, 512);
  info.serial_number = serial;
  info.lidar_port = 7502;
  info.imu_port = 7503;
  return info;
}

class RecordingSourceTest : public ::testing::Test {
 protected:
  /// Adds a scan's packets, 1 ms apart, with an IMU packet after every eighth.
  void add_scan(const SensorInfo& info, const std::string& space, std::size_t extra_bytes = 0) {
    const LidarScan scan = glint::test::random_scan(info, 7, random_);
    int count = 0;
    for (glint::test::Bytes packet : glint::test::encode(info, scan)) {
      for (std::size_t i = 0; i < extra_bytes; ++i) packet.push_back({});
      add(space + "lidar_packets", packet);
      if (++count % 8 != 0) continue;
      add(space + "imu_packets", glint::test::Bytes(kLegacyImuPacketBytes + extra_bytes));
    }
  }
  void add(const std::string& topic, const test::Buffer& body,
           TestMessage::Kind kind = TestMessage::Kind::kPacket) {
    time_ns_ += 1'000'000;
    messages_.push_back({kind, topic, time_ns_, body});
  }
  RecordingSource open(const SensorInfo& info, RecordingSourceOptions options = {}) {
    test::save(file_, test::ros1_bag(messages_));
    return RecordingSource(file_, info, std::move(options));
  }
  std::string complaint(const SensorInfo& info, const RecordingSourceOptions& options = {}) {
    try {
      open(info, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }
  static std::uint64_t drain(RecordingSource& source) {
    RawPacket packet;
    std::uint64_t count = 0;
    while (source.read(packet) == SourceStatus::kPacket) ++count;
    return count;
  }

  std::mt19937 random_{1};
  const glint::test::TempDir dir_;
  const std::filesystem::path file_ = dir_ / "recording";
  std::vector<TestMessage> messages_;
  std::int64_t time_ns_ = 0;
};

TEST_F(RecordingSourceTest, PacketsComeInFileOrderWithTheirTimesAndPorts) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  add_scan(info, "/ouster/");
  RecordingSource source = open(info);
  RawPacket packet;
  for (const TestMessage& message : messages_) {
    ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
    EXPECT_EQ(packet.bytes, message.body);
    EXPECT_EQ(packet.host_time.ns, message.time_ns);
    EXPECT_EQ(packet.port, packet.bytes.size() == kLegacyImuPacketBytes ? 7503 : 7502);
  }
  EXPECT_EQ(source.read(packet), SourceStatus::kEnd);
  EXPECT_EQ(source.counters().lidar_packets, 32U);
  EXPECT_EQ(source.counters().imu_packets, 4U);
  EXPECT_THAT(source.notices(), IsEmpty());
}

TEST_F(RecordingSourceTest, ByteThatEarlyDriversAppendedIsTakenOff) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  add_scan(info, "/os1_node/", 1);
  RecordingSource source = open(info);
  RawPacket packet;
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.bytes.size(), PacketFormat(info).packet_bytes);
  EXPECT_EQ(drain(source), 35U);
}

TEST_F(RecordingSourceTest, OtherTopicsAndSizesAreSkippedAndCounted) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  add("/velodyne_points", test::Buffer(500), TestMessage::Kind::kOther);
  add("/ouster/metadata", test::to_bytes("{}"), TestMessage::Kind::kText);
  add_scan(info, "/ouster/");
  add("/ouster/lidar_packets", test::Buffer(100));
  add("/other/lidar_packets", test::Buffer(100));
  RecordingSource source = open(info);
  EXPECT_EQ(drain(source), 36U);
  EXPECT_EQ(source.counters().other_topics, 2U);
  EXPECT_EQ(source.counters().wrong_size, 1U);
  EXPECT_EQ(source.counters().other_sensors, 1U);
}

TEST_F(RecordingSourceTest, SensorIsPickedBySerialNumber) {
  const auto info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "122");
  add_scan(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "999"), "/os_rear/");
  add_scan(info, "/os_front/");
  RecordingSource source = open(info);
  EXPECT_EQ(source.topics().lidar, "/os_front/lidar_packets");
  EXPECT_EQ(source.topics().imu, "/os_front/imu_packets");
  EXPECT_EQ(drain(source), 36U);
  EXPECT_EQ(source.counters().other_sensors, 36U);
  EXPECT_THAT(source.notices(), IsEmpty());
}

TEST_F(RecordingSourceTest, OfTwoAlikeThatBesideTheSensorsMetadataIsTakenAndTheOtherToldOf) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "122");
  add("/b/metadata", test::to_bytes(to_metadata_json(info)), TestMessage::Kind::kText);
  add_scan(info, "/a/");
  add_scan(info, "/a/");
  add_scan(info, "/b/");
  RecordingSource source = open(info);
  EXPECT_EQ(source.topics().lidar, "/b/lidar_packets");
  EXPECT_THAT(source.notices(),
              ElementsAre(AllOf(HasSubstr("/a/lidar_packets"), HasSubstr("--topic"))));
  RecordingSource other = open(info, {.topic_prefix = "/a/", .pacer = {}});
  EXPECT_EQ(drain(other), 72U);
  EXPECT_THAT(other.notices(), IsEmpty());
}

TEST_F(RecordingSourceTest, ImuPacketsOfAnotherNamespaceAreTakenAndToldOf) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  add("/imu_node/imu_packets", test::Buffer(kLegacyImuPacketBytes));
  add("/lidar_node/lidar_packets", test::Buffer(PacketFormat(info).packet_bytes));
  RecordingSource source = open(info);
  EXPECT_EQ(drain(source), 2U);
  EXPECT_THAT(source.notices(), ElementsAre(HasSubstr("/imu_node/imu_packets")));
}

TEST_F(RecordingSourceTest, WithoutTheSensorsPacketsSaysWhatWasSeenInstead) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  EXPECT_THAT(complaint(info), HasSubstr("holds no messages"));
  add("/points", test::Buffer(500), TestMessage::Kind::kOther);
  EXPECT_THAT(complaint(info), AllOf(HasSubstr("no sensor packets"),
                                     HasSubstr("1 on /points (sensor_msgs/PointCloud2)")));
  add_scan(make_sensor(LidarProfile::kLegacy, "", 32), "/ouster/");
  EXPECT_THAT(complaint(info), AllOf(HasSubstr("predicts 3392 bytes"),
                                     HasSubstr("32 of 6464 bytes on /ouster/lidar_packets")));
}

TEST_F(RecordingSourceTest, MetadataOfAnotherSensorIsRefused) {
  add_scan(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "999"), "/ouster/");
  EXPECT_THAT(complaint(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "122")),
              AllOf(HasSubstr("sensor 999"), HasSubstr("sensor 122")));
}

TEST_F(RecordingSourceTest, MetadataOfAnotherStartIsRefused) {
  SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, "999");
  add_scan(info, "/ouster/");
  info.init_id = 99;
  EXPECT_THAT(complaint(info), AllOf(HasSubstr("id 7109750"), HasSubstr("the metadata has 99")));
}

TEST_F(RecordingSourceTest, PacedPacketsWaitUntilTheyAreDueAndStopEndsReading) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  add_scan(info, "/ouster/");
  std::vector<std::int64_t> asked;
  RecordingSource source = open(info, {.topic_prefix = "", .pacer = [&](HostTime time) {
                                         asked.push_back(time.ns);
                                         return asked.size() % 2 == 0;
                                       }});
  RawPacket packet;
  EXPECT_EQ(source.read(packet), SourceStatus::kIdle);
  EXPECT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.host_time.ns, 1'000'000);
  EXPECT_THAT(asked, ElementsAre(1'000'000, 1'000'000));
  source.stop();
  EXPECT_EQ(source.read(packet), SourceStatus::kEnd);
}

TEST_F(RecordingSourceTest, RecordingThatBreaksOffIsReadAsFarAsItGoesAndToldOf) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, "");
  add_scan(info, "/ouster/");
  RecordingSource whole = open(info);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 10'000);
  RecordingSource source(file_, info);
  EXPECT_GT(drain(source), 30U);
  EXPECT_THAT(source.notices(), ElementsAre(HasSubstr("breaks off")));
}

}  // namespace
}  // namespace glint::recording
