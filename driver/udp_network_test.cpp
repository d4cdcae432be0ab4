// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A sensor and a host in network namespaces of their own, joined by two cables (veth pairs) of MTU
// 1500: real fragments, real multicast, and nothing of the machine's own network is touched.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "driver/core/error.hpp"
#include "driver/test_udp.hpp"

namespace glint {
namespace {

using test::any_port;
using test::first_byte;
using test::payload;
using test::UdpSender;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t kPacketBytes = 12'608;  // nine fragments
constexpr const char* kGroup4 = "239.201.3.4";
constexpr const char* kGroup6 = "ff05::3:4";

// One end of cable N: 10.9.N.SIDE, fd00:N::SIDE and fe80::N:SIDE.
std::string cable_end(const char* name, int cable, int side) {
  return fmt::format(
      "link set {0}{1} addrgenmode none\naddress add 10.9.{1}.{2}/24 dev {0}{1}\n"
      "address add fd00:{1}::{2}/64 dev {0}{1} nodad\naddress add fe80::{1}:{2}/64 dev {0}{1} "
      "nodad\nlink set {0}{1} up mtu 1500\n",
      name, cable, side);
}

bool ip(const std::string& commands) {
  return std::system(fmt::format("echo '{}' | ip -batch -", commands).c_str()) == 0;
}

// The kernel finishes bringing up a cable on its own time; the routes of IPv6 multicast come last.
bool wait_for_cables(int count) {
  for (int i = 0; i < 500; ++i) {
    std::ifstream in("/proc/thread-self/net/ipv6_route");
    int ready = 0;
    for (std::string line; std::getline(in, line);) ready += line.starts_with("ff0000") ? 1 : 0;
    if (ready >= count) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// Namespaces belong to a thread; sockets stay in the one they were made in.
class NetworkNamespace {
 public:
  NetworkNamespace() : fd_(open("/proc/thread-self/ns/net", O_RDONLY)) {}
  ~NetworkNamespace() { close(fd_); }
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;
  void enter() const { ASSERT_EQ(setns(fd_, CLONE_NEWNET), 0); }
  // For programs that are started, which inherit it.
  [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", fd_); }

 private:
  const int fd_;
};

class UdpNetwork : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v ip >/dev/null") != 0) GTEST_SKIP() << "needs iproute2's ip";
    if (unshare(CLONE_NEWNET) != 0) {
      GTEST_SKIP() << "making network namespaces needs root (CAP_SYS_ADMIN)";
    }
    if (!ip("link set lo up")) {
      GTEST_SKIP() << "setting network interfaces up needs CAP_NET_ADMIN";
    }
    sensor_ = std::make_unique<NetworkNamespace>();
    ASSERT_EQ(unshare(CLONE_NEWNET), 0);
    host_ = std::make_unique<NetworkNamespace>();
    // With different indices the kernel takes a cable that is plugged in for urgent news.
    ASSERT_TRUE(ip(fmt::format(
        "link add host0 index 10 type veth peer name sensor0 index 20 netns {0}\n"
        "link add host1 index 11 type veth peer name sensor1 index 21 netns {0}\n{1}{2}",
        sensor_->path(), cable_end("host", 0, 1), cable_end("host", 1, 1))));
    sensor_->enter();
    ASSERT_TRUE(ip(cable_end("sensor", 0, 2) + cable_end("sensor", 1, 2)));
    ASSERT_TRUE(wait_for_cables(2));
    host_->enter();
    ASSERT_TRUE(wait_for_cables(2));
  }
  void TearDown() override {
    if (sensor_) home_.enter();
  }

  [[nodiscard]] bool send(const std::string& from, const std::string& to, std::uint16_t port,
                          int value) const {
    sensor_->enter();
    const bool sent = UdpSender(from).send(to, port, payload(kPacketBytes, value));
    host_->enter();
    return sent;
  }
  // Datagrams put together from fragments, by the kernel's own count: a line with name and value
  // for IPv6, a line of names above one of values for IPv4.
  static int reassembled(const char* file, const char* name) {
    std::ifstream in(file);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    const auto named = std::find(words.begin(), words.end(), name);
    if (words.end() - named < 2) return -1;
    if (std::string(file).ends_with("snmp6")) return std::stoi(named[1]);
    const auto names = std::find(words.begin(), words.end(), "Ip:");
    return std::stoi(std::find(names + 1, words.end(), "Ip:")[named - names]);
  }

  const NetworkNamespace home_;
  std::unique_ptr<NetworkNamespace> sensor_;
  std::unique_ptr<NetworkNamespace> host_;
};

TEST_F(UdpNetwork, FragmentsOfBothFamiliesArriveAsWholeDatagrams) {
  UdpSource source(any_port());
  const std::uint16_t port = source.lidar_port();
  RawPacket packet;
  ASSERT_TRUE(send("10.9.0.2", "10.9.0.1", port, 4));
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.bytes, payload(kPacketBytes, 4));
  ASSERT_TRUE(send("fd00:0::2", "fd00:0::1", port, 6));
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.bytes, payload(kPacketBytes, 6));
  EXPECT_EQ(reassembled("/proc/thread-self/net/snmp", "ReasmOKs"), 1);
  EXPECT_EQ(reassembled("/proc/thread-self/net/snmp6", "Ip6ReasmOKs"), 1);
}

TEST_F(UdpNetwork, SensorsOfBothFamiliesAreToldApartByAddress) {
  UdpSourceOptions options = any_port();
  options.source_address = "fd00:1::2";
  UdpSource source(options);
  const std::uint16_t port = source.lidar_port();
  ASSERT_TRUE(send("10.9.0.2", "10.9.0.1", port, 1));
  ASSERT_TRUE(send("fd00:0::2", "fd00:0::1", port, 2));
  ASSERT_TRUE(send("fd00:1::2", "fd00:1::1", port, 3));
  EXPECT_EQ(first_byte(source), 3);
  EXPECT_EQ(source.foreign(), 2U);
  source.set_source_address("10.9.0.2");
  ASSERT_TRUE(send("fd00:1::2", "fd00:1::1", port, 4));
  ASSERT_TRUE(send("10.9.0.2", "10.9.0.1", port, 5));
  EXPECT_EQ(first_byte(source), 5);
  EXPECT_EQ(source.foreign(), 3U);
}

TEST_F(UdpNetwork, LinkLocalAddressesWorkWithAndWithoutTheirInterface) {
  for (const char* const address : {"fe80::1:1%host1", "fe80::1:1"}) {
    UdpSourceOptions options = any_port();
    options.bind_address = address;
    options.source_address = "fe80::1:2";
    UdpSource source(options);
    ASSERT_TRUE(send("fe80::1:2%sensor1", "fe80::1:1%sensor1", source.lidar_port(), 7));
    EXPECT_EQ(first_byte(source), 7) << address;
  }
}

struct MulticastCase {
  const char* family;
  const char* group;
  const char* bind_address;
  const char* from;        // a sensor on the same cable,
  const char* to;          // what it sends to,
  const char* other_from;  // and one on the other cable
  const char* other_to;
};

class UdpMulticast : public UdpNetwork, public testing::WithParamInterface<MulticastCase> {
 protected:
  static UdpSourceOptions options() {
    UdpSourceOptions options = any_port();
    options.multicast_group = GetParam().group;
    options.bind_address = GetParam().bind_address;
    return options;
  }
};

TEST_P(UdpMulticast, GroupIsReceivedOnItsInterfaceOnly) {
  const MulticastCase& c = GetParam();
  UdpSource source(options());
  // Another program has joined it on every cable; that must not open this one.
  UdpSourceOptions other = options();
  other.lidar_port = 7777;
  other.bind_address = std::string(c.family) == "IPv4" ? "10.9.1.1" : "fd00:1::1";
  if (std::string(c.group).find('%') != std::string::npos) other.multicast_group = "ff02::7%host1";
  const UdpSource elsewhere(other);
  ASSERT_TRUE(send(c.other_from, c.other_to, source.lidar_port(), 1));
  ASSERT_TRUE(send(c.from, c.to, source.lidar_port(), 2));
  RawPacket packet;
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.bytes, payload(kPacketBytes, 2));
  EXPECT_EQ(first_byte(source), std::nullopt);
}

TEST_P(UdpMulticast, ProgramsShareThePortAndEachGetsEverything) {
  const MulticastCase& c = GetParam();
  UdpSource first(options());
  UdpSourceOptions same = options();
  same.lidar_port = first.lidar_port();
  UdpSource second(same);
  ASSERT_TRUE(send(c.from, c.to, first.lidar_port(), 5));
  EXPECT_EQ(first_byte(first), 5);
  EXPECT_EQ(first_byte(second), 5);
}

TEST_P(UdpMulticast, UnicastIsNotTakenFromOthers) {
  const MulticastCase& c = GetParam();
  UdpSource source(options());
  const bool ipv4 = std::string(c.family) == "IPv4";
  ASSERT_TRUE(send(ipv4 ? "10.9.0.2" : "fd00:0::2", ipv4 ? "10.9.0.1" : "fd00:0::1",
                   source.lidar_port(), 5));
  EXPECT_EQ(first_byte(source), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Families, UdpMulticast,
                         testing::Values(MulticastCase{"IPv4", kGroup4, "10.9.0.1", "10.9.0.2",
                                                       kGroup4, "10.9.1.2", kGroup4},
                                         MulticastCase{"IPv6", kGroup6, "fd00:0::1", "fd00:0::2",
                                                       kGroup6, "fd00:1::2", kGroup6},
                                         MulticastCase{"IPv6LinkLocal", "ff02::7%host0", "",
                                                       "fe80::0:2%sensor0", "ff02::7%sensor0",
                                                       "fe80::1:2%sensor1", "ff02::7%sensor1"}),
                         [](const auto& one) { return one.param.family; });

TEST_F(UdpNetwork, WithoutBindAddressTheRouteTellsTheGroupsInterface) {
  UdpSourceOptions options = any_port();
  options.multicast_group = kGroup4;
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("no route tells the interface")));
  ASSERT_TRUE(ip("route add 239.0.0.0/8 dev host1\n"));
  UdpSource source(options);
  ASSERT_TRUE(send("10.9.1.2", kGroup4, source.lidar_port(), 1));
  EXPECT_EQ(first_byte(source), 1);
}

TEST_F(UdpNetwork, GroupThatCannotBeJoinedSaysWhy) {
  UdpSourceOptions options = any_port();
  const auto open = [&] { UdpSource source(options); };
  options.multicast_group = kGroup4;
  options.bind_address = "10.9.7.1";
  EXPECT_THAT(open, ThrowsMessage<InputError>(HasSubstr("10.9.7.1 is none of this machine's")));
  options.multicast_group = kGroup6;
  options.bind_address = "fd00:7::1";
  EXPECT_THAT(open, ThrowsMessage<InputError>(HasSubstr("fd00:7::1 is none of this machine's")));
  options.multicast_group = "ff02::7";
  options.bind_address = "";
  EXPECT_THAT(open, ThrowsMessage<InputError>(HasSubstr("ff02::7%INTERFACE")));
}

TEST_F(UdpNetwork, APortHeldForUnicastIsNotSharedWithAGroup) {
  const UdpSource holder(any_port());
  UdpSourceOptions options = any_port();
  options.lidar_port = holder.lidar_port();
  options.multicast_group = kGroup4;
  options.bind_address = "10.9.0.1";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("is held by another program")));
}

}  // namespace
}  // namespace glint
