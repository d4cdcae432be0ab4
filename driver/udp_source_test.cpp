// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/udp_source.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <future>
#include <vector>

#include "driver/core/error.hpp"

namespace glint {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Sends datagrams to a port of this machine, over IPv4 or IPv6.
class Sender {
 public:
  explicit Sender(int family = AF_INET) : family_(family), fd_(socket(family, SOCK_DGRAM, 0)) {}
  ~Sender() { close(fd_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  bool send(std::uint16_t port, const std::vector<std::byte>& bytes) const {
    sockaddr_storage to{};
    socklen_t size = 0;
    if (family_ == AF_INET6) {
      sockaddr_in6 v6{};
      v6.sin6_family = AF_INET6;
      v6.sin6_port = htons(port);
      v6.sin6_addr = in6addr_loopback;
      std::memcpy(&to, &v6, size = sizeof v6);
    } else {
      sockaddr_in v4{};
      v4.sin_family = AF_INET;
      v4.sin_port = htons(port);
      v4.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      std::memcpy(&to, &v4, size = sizeof v4);
    }
    return sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), size) ==
           static_cast<ssize_t>(bytes.size());
  }

 private:
  int family_;
  int fd_;
};

UdpSourceOptions any_port() {
  UdpSourceOptions options;
  options.lidar_port = 0;
  options.imu_port = 0;
  return options;
}

std::uint16_t free_port() { return UdpSource(any_port()).lidar_port(); }

std::vector<std::byte> payload(std::size_t size, int value) {
  return std::vector<std::byte>(size, static_cast<std::byte>(value));
}

TEST(UdpSource, DatagramsComeWithPortAndTimeOfArrival) {
  UdpSource source(any_port());
  const Sender sender;
  ASSERT_TRUE(sender.send(source.lidar_port(), payload(12'608, 7)));
  RawPacket packet;
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.bytes, payload(12'608, 7));
  EXPECT_EQ(packet.port, source.lidar_port());
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(static_cast<double>(packet.host_time.ns) * 1e-9,
              std::chrono::duration<double>(now).count(), 60.0);
}

TEST(UdpSource, BothFamiliesReachOneSocket) {
  UdpSource source(any_port());
  const Sender sender(AF_INET6);
  if (!sender.send(source.lidar_port(), payload(48, 1))) GTEST_SKIP() << "no IPv6 on this machine";
  RawPacket packet;
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  ASSERT_TRUE(Sender().send(source.lidar_port(), payload(48, 2)));
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(packet.bytes, payload(48, 2));
}

TEST(UdpSource, ImuPortIsReadToo) {
  UdpSourceOptions options = any_port();
  options.imu_port = free_port();
  UdpSource source(options);
  const Sender sender;
  // A flood on the lidar port must not hold back the other.
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sender.send(source.lidar_port(), payload(100, i)));
  ASSERT_TRUE(sender.send(options.imu_port, payload(48, 99)));
  RawPacket packet;
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  if (packet.port != options.imu_port) {
    ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  }
  EXPECT_EQ(packet.port, options.imu_port);
  EXPECT_EQ(packet.bytes, payload(48, 99));
}

TEST(UdpSource, OtherSendersAreCountedAndDropped) {
  UdpSourceOptions options = any_port();
  options.source_address = "192.0.2.1";
  UdpSource strict(options);
  options.source_address = "127.0.0.1";
  UdpSource matching(options);
  const Sender sender;
  RawPacket packet;
  ASSERT_TRUE(sender.send(strict.lidar_port(), payload(48, 1)));
  EXPECT_EQ(strict.read(packet), SourceStatus::kIdle);
  EXPECT_EQ(strict.counters().foreign, 1U);
  ASSERT_TRUE(sender.send(matching.lidar_port(), payload(48, 1)));
  EXPECT_EQ(matching.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(matching.counters().foreign, 0U);
}

TEST(UdpSource, PortInUseIsNamed) {
  const UdpSource holder(any_port());
  UdpSourceOptions options = any_port();
  options.lidar_port = holder.lidar_port();
  const std::string port = std::to_string(holder.lidar_port());
  EXPECT_THAT(
      [&] { UdpSource second(options); },
      ThrowsMessage<InputError>(
          AllOf(HasSubstr("port " + port + " is held by another program"), HasSubstr("ss -ulnp"))));
  options.bind_address = "127.0.0.1";
  EXPECT_THROW(UdpSource third(options), InputError) << "also by an address of its own";
}

TEST(UdpSource, WrongAddressesAreRefusedByName) {
  UdpSourceOptions options = any_port();
  options.bind_address = "lidar";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("bind address lidar is no IP address")));
  options.bind_address = "192.0.2.77";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("192.0.2.77 is none of this machine's")));
  options.bind_address = "";
  options.source_address = "1.2.3";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("source address 1.2.3")));
}

TEST(UdpSource, BoundToOneAddressItReceivesThere) {
  UdpSourceOptions options = any_port();
  options.bind_address = "127.0.0.1";
  UdpSource source(options);
  ASSERT_TRUE(Sender().send(source.lidar_port(), payload(48, 3)));
  RawPacket packet;
  EXPECT_EQ(source.read(packet), SourceStatus::kPacket);
}

TEST(UdpSource, SilenceIsIdleAndStopWakesAtOnce) {
  UdpSource source(any_port());
  RawPacket packet;
  EXPECT_EQ(source.read(packet), SourceStatus::kIdle);
  auto ended = std::async(std::launch::async, [&] {
    SourceStatus status = SourceStatus::kIdle;
    while (status == SourceStatus::kIdle) status = source.read(packet);
    return status;
  });
  source.stop();
  ASSERT_EQ(ended.wait_for(5s), std::future_status::ready);
  EXPECT_EQ(ended.get(), SourceStatus::kEnd);
  EXPECT_EQ(source.read(packet), SourceStatus::kEnd);
}

TEST(UdpSource, KernelDropsAreCounted) {
  UdpSourceOptions options = any_port();
  options.rcvbuf_bytes = 1;  // the kernel grants its least
  UdpSource source(options);
  const Sender sender;
  constexpr int kSent = 100;
  for (int i = 0; i < kSent; ++i) ASSERT_TRUE(sender.send(source.lidar_port(), payload(1000, i)));
  RawPacket packet;
  std::uint64_t received = 0;
  while (source.read(packet) == SourceStatus::kPacket) ++received;
  ASSERT_LT(received, kSent);
  // The kernel tells its count with the next packet that it queues.
  ASSERT_TRUE(sender.send(source.lidar_port(), payload(1000, 1)));
  ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
  EXPECT_EQ(source.kernel_drops(), kSent - received);
}

TEST(UdpSource, GrantedReceiveBufferIsReadBack) {
  UdpSourceOptions options = any_port();
  options.rcvbuf_bytes = 64 << 10;
  EXPECT_EQ(UdpSource(options).granted_rcvbuf_bytes(), 64 << 10);
}

}  // namespace
}  // namespace glint
