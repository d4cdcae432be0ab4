// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// `glint record` from an emulated sensor: what arrived is in the capture, whatever ends it.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <thread>

#include "pcap/pcap_source.hpp"
#include "tests/integration/glint_command.hpp"
#include "tests/integration/small_world.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::HasSubstr;

class RecordTest : public ::testing::Test {
 protected:
  RecordTest()
      : port_(test::free_udp_ports()),
        sensor_({"emulate", world_.capture, "--http", "0", "--firmware", "v3.1.0", "--reinitialise",
                 "0.1", "--report", world_.report}),
        host_("127.0.0.1:" + std::to_string(sensor_.number_after("HTTP on port "))) {}

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    const std::string port = std::to_string(port_);
    std::vector<std::string> words = {"record",      "--sensor",     host_, "--out",      out_,
                                      "--configure", "--lidar-port", port,  "--imu-port", port};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Lidar packets of a capture that is read with the metadata beside it.
  static std::uint64_t lidar_packets(const fs::path& capture) {
    fs::path metadata = capture;
    const SensorInfo info = load_sensor_info(metadata.replace_extension(".json"));
    PcapSource source(capture, info, {});
    RawPacket packet;
    std::uint64_t count = 0;
    while (source.read(packet) == SourceStatus::kPacket) {
      if (packet.bytes.size() == PacketFormat(info).packet_bytes) ++count;
    }
    return count;
  }

  const test::SmallWorld world_{LidarProfile::kRng19Rfl8Sig16Nir16};
  const std::uint16_t port_;
  const fs::path out_ = world_.dir / "drive.pcap";
  test::GlintProcess sensor_;
  const std::string host_;
};

TEST_F(RecordTest, WhatTheSensorSendsIsInTheCapture) {
  const auto result = test::run_glint(command({"--seconds", "1.5"}));
  ASSERT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("dropped by the kernel 0, for a slow disk 0"));
  const std::uint64_t packets = lidar_packets(out_);
  EXPECT_NEAR(static_cast<double>(packets), 1.5 * 320, 100.0);
  EXPECT_THAT(result.out, HasSubstr("recorded " + std::to_string(packets) + " lidar"));
  const auto dump = test::run_glint({"dump", out_, "--out", world_.dir / "dump"});
  EXPECT_EQ(dump.exit_code, 0) << dump.out;
}

TEST_F(RecordTest, AKillLeavesAllButTheLastSecondReadable) {
  test::GlintProcess record(command({}));
  record.wait_for("recording ports");
  std::this_thread::sleep_for(3s);
  record.send_signal(SIGKILL);
  EXPECT_EQ(record.finish().exit_code, -1);
  EXPECT_GE(lidar_packets(out_), 2U * 320U - 64U);
  EXPECT_EQ(test::run_glint({"info", out_}).exit_code, 0);
}

TEST_F(RecordTest, ASignalEndsItCleanly) {
  test::GlintProcess record(command({}));
  record.wait_for("recording ports");
  std::this_thread::sleep_for(500ms);
  record.send_signal(SIGINT);
  const auto result = record.finish();
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("in 1 file"));
  EXPECT_GT(lidar_packets(out_), 0U);
}

TEST_F(RecordTest, EachPartIsACaptureOfItsOwn) {
  // 320 packets of 3328 bytes a second.
  const auto result =
      test::run_glint(command({"--seconds", "4", "--split", "1", "--max-total", "3"}));
  ASSERT_EQ(result.exit_code, 0) << result.out;
  int parts = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(out_.parent_path())) {
    const std::string name = file.path().filename();
    if (!name.starts_with("drive_") || file.path().extension() != ".pcap") continue;
    ++parts;
    EXPECT_GT(lidar_packets(file.path()), 0U) << name;
    EXPECT_LT(file.file_size(), 1'010'000U);
  }
  EXPECT_GE(parts, 2);
  EXPECT_LE(parts, 3);
  EXPECT_FALSE(fs::exists(out_.parent_path() / "drive_0001.pcap"));
  EXPECT_THAT(result.out, HasSubstr("older ones deleted"));
}

TEST_F(RecordTest, AFullDiskIsSaidAndWhatIsThereStaysReadable) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 500'000;
  setrlimit(RLIMIT_FSIZE, &small);  // As inherited by the command.
  const auto result = test::run_glint(command({"--seconds", "10"}));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("drive.pcap cannot be written: File too large"));
  EXPECT_NEAR(static_cast<double>(lidar_packets(out_)), 145.0, 10.0);
}

TEST_F(RecordTest, AnUnreachableSensorIsNamed) {
  const auto result =
      test::run_glint({"record", "--sensor", "127.0.0.1:9", "--out", out_, "--wait", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("127.0.0.1 refuses connections on port 9"));
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace glint
