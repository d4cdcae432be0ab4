// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "daemon/doctor/judgement.hpp"
#include "daemon/doctor/proc_text.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::daemon {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string fixture(const std::string& name) {
  std::ifstream in(GLINT_SOURCE_DIR "/daemon/doctor/testdata/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ProcText, CountersAreFoundByTheirNames) {
  const std::string snmp = fixture("snmp.txt");
  EXPECT_EQ(parse_snmp(snmp, "Udp", "RcvbufErrors"), 1234U);
  EXPECT_EQ(parse_snmp(snmp, "Ip", "ReasmFails"), 57U);
  EXPECT_EQ(parse_snmp(snmp, "UdpLite", "RcvbufErrors"), 8U);
  EXPECT_EQ(parse_snmp(snmp, "Udp", "NoSuch"), std::nullopt);
  EXPECT_EQ(parse_snmp(snmp, "Sctp", "InErrors"), std::nullopt);
  EXPECT_EQ(parse_snmp("", "Udp", "RcvbufErrors"), std::nullopt);
  EXPECT_EQ(parse_snmp("Udp: A B\nUdp: 1", "Udp", "B"), std::nullopt) << "a row cut short";
  EXPECT_EQ(parse_snmp("Udp: A\nUdp: x", "Udp", "A"), std::nullopt);
}

TEST(ProcText, UdpSocketsHavePortInodeAndDrops) {
  const auto sockets = parse_udp_sockets(fixture("udp.txt"));
  ASSERT_EQ(sockets.size(), 3U);
  EXPECT_EQ(sockets[0].local_port, 7502);
  EXPECT_EQ(sockets[0].inode, 48213U);
  EXPECT_EQ(sockets[0].drops, 77U);
  EXPECT_EQ(sockets[2].local_port, 68);
  const auto v6 = parse_udp_sockets(fixture("udp6.txt"));
  ASSERT_EQ(v6.size(), 1U);
  EXPECT_EQ(v6[0].local_port, 7503);
  EXPECT_TRUE(
      parse_udp_sockets("1: nonsense\n 2: 0:1 2 3 4 5 6 7 8\n 3: 0:XY 2 3 4 5 6 7 8 9").empty());
}

TEST(ProcText, ANumberIsOneAndNothingElse) {
  EXPECT_EQ(parse_number("212992\n"), 212992);
  EXPECT_EQ(parse_number(""), std::nullopt);
  EXPECT_EQ(parse_number("1 2\n"), std::nullopt);
}

class JudgementTest : public testing::Test {
 protected:
  JudgementTest() {
    sensor_.product_line = "OS-1-64";
    sensor_.serial_number = "122201000998";
    sensor_.firmware = "v2.5.0";
    sensor_.status = "RUNNING";
    sensor_.udp_dest = "10.5.5.1";
    sensor_.info = glint::test::make_sensor(LidarProfile::kLegacy, 64, 1024);
    host_.own_addresses = {"127.0.0.1", "10.5.5.1"};
    host_.rmem_max_bytes = 26'214'400;
    route_.route = Route{"10.5.5.7", "10.5.5.1", "eth1", 1500};
    packets_.seconds = 1.5;
    packets_.listened = true;
    packets_.lidar = 960;
    packets_.imu = 150;
  }

  /// The one finding of a step; fails when there are others.
  static Finding of(const Findings& findings, const std::string& step) {
    Finding found;
    int count = 0;
    for (const Finding& finding : findings) {
      // Whatever is not OK says how to mend it.
      EXPECT_EQ(finding.mend.empty(), finding.level == FindingLevel::kOk) << finding.what;
      if (finding.step != step) continue;
      found = finding;
      ++count;
    }
    EXPECT_EQ(count, 1) << step;
    return found;
  }

  SensorFacts sensor_;
  HostFacts host_;
  RouteLookup route_;
  PacketFacts packets_;
  DoctorWishes wishes_{8 << 20, {}, "10.5.5.7"};
};

TEST_F(JudgementTest, AllIsWellWhenItIs) {
  for (const Findings& findings :
       {judge_sensor(sensor_, host_, wishes_), judge_buffers(host_, wishes_),
        judge_packets(packets_, host_, sensor_, route_)}) {
    EXPECT_FALSE(findings.empty());
    for (const Finding& finding : findings) {
      EXPECT_EQ(finding.level, FindingLevel::kOk) << finding.step << finding.what;
    }
  }
}

TEST_F(JudgementTest, ASensorThatDoesNotAnswerIsTheOnlyFindingOfIt) {
  sensor_.failure = "10.5.5.7 refuses connections on port 80";
  const Findings findings = judge_sensor(sensor_, host_, wishes_);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].what, sensor_.failure);
  EXPECT_EQ(findings[0].level, FindingLevel::kFail);
}

TEST_F(JudgementTest, ADestinationElsewhereFailsWithBothNamed) {
  sensor_.udp_dest = "10.5.5.99";
  const Finding found = of(judge_sensor(sensor_, host_, wishes_), "destination");
  EXPECT_EQ(found.level, FindingLevel::kFail);
  EXPECT_THAT(found.what, HasSubstr("10.5.5.99"));
  EXPECT_THAT(found.mend, HasSubstr("sensor.configure"));
  sensor_.udp_dest = "239.201.201.201";
  EXPECT_EQ(of(judge_sensor(sensor_, host_, wishes_), "destination").level, FindingLevel::kOk);
}

TEST_F(JudgementTest, StandbyErrorsAlertsAndPtpAreTold) {
  sensor_.status = "STANDBY";
  EXPECT_EQ(of(judge_sensor(sensor_, host_, wishes_), "status").level, FindingLevel::kFail);
  sensor_.status = "ERROR";
  sensor_.alerts = {{kLidarUnreachableAlert, "UDP_TRANSMISSION", "WARNING", "no receiver"}};
  sensor_.timestamp_mode = "TIME_FROM_PTP_1588";
  sensor_.ptp = PtpState{"LISTENING", "", {}, {}, false};
  const Findings findings = judge_sensor(sensor_, host_, wishes_);
  EXPECT_EQ(of(findings, "status").level, FindingLevel::kFail);
  EXPECT_THAT(of(findings, "alerts").what, HasSubstr("0x01000015"));
  EXPECT_EQ(of(findings, "clock").level, FindingLevel::kWarn);
  EXPECT_EQ(first_failure(findings)->step, "status") << "the first on the way";
}

TEST_F(JudgementTest, ASmallReceiveBufferNamesTheLineThatMendsIt) {
  host_.rmem_max_bytes = 212'992;
  const Finding found = of(judge_buffers(host_, wishes_), "receive buffer");
  EXPECT_EQ(found.level, FindingLevel::kWarn);
  EXPECT_EQ(found.mend, "sysctl -w net.core.rmem_max=8388608");
}

TEST_F(JudgementTest, OnlyErrorsThatGrowAreFindings) {
  host_.before = {100, 5};
  host_.after = {100, 5};
  EXPECT_EQ(of(judge_buffers(host_, wishes_), "kernel drops").level, FindingLevel::kOk);
  host_.after = {103, 9};
  EXPECT_THAT(of(judge_buffers(host_, wishes_), "kernel drops").what, HasSubstr("3 datagrams"));
  EXPECT_THAT(of(judge_buffers(host_, wishes_), "reassembly").mend,
              HasSubstr("ipfrag_high_thresh"));
}

TEST_F(JudgementTest, FragmentsAreCountedAsTheKernelMakesThem) {
  const Finding found = of(judge_fragments(route_, sensor_), "MTU");
  EXPECT_EQ(found.level, FindingLevel::kWarn);
  EXPECT_THAT(found.what, AllOf(HasSubstr("12608 bytes"), HasSubstr("9 fragments")));
  EXPECT_THAT(found.mend, HasSubstr("ip link set eth1 mtu 9000"));
  route_.route->mtu = 65'536;
  EXPECT_EQ(of(judge_fragments(route_, sensor_), "MTU").level, FindingLevel::kOk);
}

TEST_F(JudgementTest, AHeldPortNamesItsHolder) {
  host_.ports = {{7502, true, "nc (pid 12)"}, {7503, false, {}}};
  const Findings findings = judge_ports(host_);
  EXPECT_EQ(findings[0].level, FindingLevel::kFail);
  EXPECT_THAT(findings[0].what, HasSubstr("nc (pid 12)"));
  EXPECT_EQ(findings[1].level, FindingLevel::kOk);
  host_.ports = {{7502, true, "glintd (pid 12)"}};
  EXPECT_EQ(judge_ports(host_)[0].level, FindingLevel::kOk);
}

TEST_F(JudgementTest, SilenceIsPutDownToWhatIsKnown) {
  packets_.lidar = packets_.imu = 0;
  packets_.on_wire = 900;
  EXPECT_THAT(of(judge_packets(packets_, host_, sensor_, route_), "packets").what,
              HasSubstr("firewall"));
  host_.rp_filter = 1;
  EXPECT_THAT(of(judge_packets(packets_, host_, sensor_, route_), "packets").mend,
              HasSubstr("rp_filter=2"));
  packets_.on_wire = 0;
  const Finding nothing = of(judge_packets(packets_, host_, sensor_, route_), "packets");
  EXPECT_EQ(nothing.level, FindingLevel::kFail);
  EXPECT_THAT(nothing.what, HasSubstr("neither on the wire"));
  packets_.imu = 150;
  EXPECT_THAT(of(judge_packets(packets_, host_, sensor_, route_), "packets").what,
              HasSubstr("fragments"));
}

TEST_F(JudgementTest, PacketsOfOtherSettingsAreToldByBothSizes) {
  packets_.lidar = packets_.imu = 0;
  packets_.other = 10;
  packets_.other_bytes = 6464;
  EXPECT_THAT(of(judge_packets(packets_, host_, sensor_, route_), "packets").what,
              AllOf(HasSubstr("6464"), HasSubstr("12608")));
}

TEST_F(JudgementTest, GravityIsComparedWithTheMounting) {
  packets_.up_mps2 = Eigen::Vector3d(0.0, 0.0, 9.8);
  EXPECT_EQ(of(judge_gravity(packets_, wishes_), "gravity").level, FindingLevel::kOk);
  wishes_.T_base_sensor.rotation = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  EXPECT_THAT(of(judge_gravity(packets_, wishes_), "gravity").what, HasSubstr("180 degrees"));
  packets_.up_mps2 = Eigen::Vector3d(0.0, 0.0, -9.8);
  EXPECT_EQ(of(judge_gravity(packets_, wishes_), "gravity").level, FindingLevel::kOk);
  packets_.up_mps2 = Eigen::Vector3d(0.0, 0.0, -1.0);
  EXPECT_THAT(of(judge_gravity(packets_, wishes_), "gravity").what, HasSubstr("1.00 m/s^2"));
  packets_.up_mps2.reset();
  EXPECT_THAT(of(judge_gravity(packets_, wishes_), "gravity").what, HasSubstr("did not rest"));
  EXPECT_TRUE(judge_gravity({}, wishes_).empty());
}

}  // namespace
}  // namespace glint::daemon
