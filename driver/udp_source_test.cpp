// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/udp_source.hpp"

#include <gmock/gmock.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

#include "driver/core/error.hpp"
#include "driver/test_udp.hpp"

namespace glint {
namespace {

using namespace std::chrono_literals;
using test::any_port;
using test::first_byte;
using test::free_port;
using test::payload;
using test::UdpSender;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Keeps a thread on one processor: what it sends then arrives in that order. Where it moves to
/// another one, a busy machine may deliver the later datagram first.
class OnOneProcessor {
 public:
  OnOneProcessor() {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
    sched_setaffinity(0, sizeof one, &one);
  }
  ~OnOneProcessor() { sched_setaffinity(0, sizeof before_, &before_); }
  OnOneProcessor(const OnOneProcessor&) = delete;
  OnOneProcessor& operator=(const OnOneProcessor&) = delete;

 private:
  cpu_set_t before_{};
};

TEST(UdpSource, DatagramsComeWithPortAndTimeOfArrival) {
  UdpSource source(any_port());
  const UdpSender sender;
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
  try {
    ASSERT_TRUE(UdpSender("::1").send(source.lidar_port(), payload(48, 1)));
  } catch (const std::runtime_error&) {
    GTEST_SKIP() << "no IPv6 on this machine";
  }
  EXPECT_EQ(first_byte(source), 1);
  ASSERT_TRUE(UdpSender().send(source.lidar_port(), payload(48, 2)));
  EXPECT_EQ(first_byte(source), 2);
}

TEST(UdpSource, DatagramsOfEverySizeAreWhole) {
  UdpSource source(any_port());
  const UdpSender sender;
  const std::vector<std::size_t> sizes{1, 48, 12'608, 48, 24'896, 0, 65'507, 12'608, 65'507};
  // First one by one, then all in one batch.
  for (const bool batched : {false, true}) {
    RawPacket packet;
    int value = 0;
    for (std::size_t size : sizes) {
      ASSERT_TRUE(sender.send(source.lidar_port(), payload(size, ++value)));
      if (batched) continue;
      ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
      EXPECT_EQ(packet.bytes, payload(size, value));
    }
    for (std::size_t i = 0; batched && i < sizes.size(); ++i) {
      ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
      EXPECT_EQ(packet.bytes, payload(sizes[i], static_cast<int>(i) + 1));
    }
  }
}

TEST(UdpSource, MoreThanABatchComesInOrder) {
  UdpSource source(any_port());
  const UdpSender sender;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(sender.send(source.lidar_port(), payload(1000, i)));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(first_byte(source), i);
  EXPECT_EQ(first_byte(source), std::nullopt);
}

TEST(UdpSource, BothPortsComeInTheOrderOfArrival) {
  UdpSourceOptions options = any_port();
  options.imu_port = free_port();
  UdpSource source(options);
  const UdpSender sender;
  const OnOneProcessor in_order;
  for (int i = 0; i < 30; ++i) {
    const bool imu = i % 3 == 2;
    ASSERT_TRUE(sender.send(imu ? options.imu_port : source.lidar_port(), payload(100, i)));
  }
  RawPacket packet;
  HostTime last;
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(source.read(packet), SourceStatus::kPacket);
    EXPECT_EQ(packet.bytes, payload(100, i));
    EXPECT_EQ(packet.port, i % 3 == 2 ? options.imu_port : source.lidar_port());
    EXPECT_GE(packet.host_time, last);
    last = packet.host_time;
  }
}

TEST(UdpSource, BothPortsComeInTheOrderOfArrivalWhenManyWait) {
  UdpSourceOptions options = any_port();
  options.imu_port = free_port();
  UdpSource source(options);
  const UdpSender sender;
  const OnOneProcessor in_order;
  for (int i = 0; i < 100; ++i) {
    const bool imu = i % 45 == 44;
    ASSERT_TRUE(sender.send(imu ? options.imu_port : source.lidar_port(), payload(100, i)));
  }
  for (int i = 0; i < 100; ++i) EXPECT_EQ(first_byte(source), i);
}

TEST(UdpSource, BothPortsComeInTheOrderOfArrivalWhileMoreArrive) {
  constexpr int kPackets = 5000;
  UdpSourceOptions options = any_port();
  options.imu_port = free_port();
  UdpSource source(options);
  // No more than the buffers hold may be on its way.
  std::atomic<int> read = 0;
  std::thread sending([&] {
    const UdpSender sender;
    const OnOneProcessor in_order;
    for (int i = 0; i < kPackets; ++i) {
      while (i - read > 50) std::this_thread::yield();
      sender.send(i % 2 == 0 ? options.imu_port : source.lidar_port(), payload(100, i));
    }
  });
  for (int i = 0; i < kPackets; ++i) {
    EXPECT_EQ(first_byte(source), i % 256);
    ++read;
  }
  sending.join();
}

TEST(UdpSource, OnePortServesLidarAndImu) {
  UdpSourceOptions options = any_port();
  options.lidar_port = options.imu_port = free_port();
  UdpSource source(options);
  const UdpSender sender;
  ASSERT_TRUE(sender.send(options.lidar_port, payload(12'608, 1)));
  ASSERT_TRUE(sender.send(options.imu_port, payload(48, 2)));
  EXPECT_EQ(first_byte(source), 1);
  EXPECT_EQ(first_byte(source), 2);
}

TEST(UdpSource, TwoSensorsOnOnePortAreToldApartByAddress) {
  // Two programs, each on an address of its own, and both sensors send to both.
  UdpSourceOptions options = any_port();
  options.lidar_port = free_port();
  options.bind_address = "127.0.0.4";
  options.source_address = "127.0.0.2";
  UdpSource of_two(options);
  options.bind_address = "127.0.0.5";
  options.source_address = "127.0.0.3";
  UdpSource of_three(options);
  const UdpSender two("127.0.0.2");
  const UdpSender three("127.0.0.3");
  for (int i = 0; i < 10; ++i) {
    for (const char* to : {"127.0.0.4", "127.0.0.5"}) {
      ASSERT_TRUE(three.send(to, options.lidar_port, payload(100, 30 + i)));
      ASSERT_TRUE(two.send(to, options.lidar_port, payload(100, 20 + i)));
    }
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(first_byte(of_two), 20 + i);
    EXPECT_EQ(first_byte(of_three), 30 + i);
  }
  EXPECT_EQ(first_byte(of_two), std::nullopt);
  EXPECT_EQ(first_byte(of_three), std::nullopt);
  EXPECT_EQ(of_two.foreign(), 10U);
  EXPECT_EQ(of_three.foreign(), 10U);
}

TEST(UdpSource, SourceAddressCanBeLearntWhileRunning) {
  UdpSource source(any_port());
  auto reader = std::async(std::launch::async, [&] {
    std::vector<int> last(2, -1);
    RawPacket packet;
    for (;;) {
      const SourceStatus status = source.read(packet);
      if (status == SourceStatus::kEnd) return last;
      if (status == SourceStatus::kPacket) {
        last[std::to_integer<std::size_t>(packet.bytes[0])] = std::to_integer<int>(packet.bytes[1]);
      }
    }
  });
  const UdpSender two("127.0.0.2");
  const UdpSender three("127.0.0.3");
  const auto send = [&](int round) {
    std::vector<std::byte> bytes{std::byte{0}, static_cast<std::byte>(round)};
    two.send(source.lidar_port(), bytes);
    bytes[0] = std::byte{1};
    three.send(source.lidar_port(), bytes);
  };
  send(1);
  EXPECT_EQ(source.foreign(), 0U);
  source.set_source_address("127.0.0.3");
  // The call of the kernel that is under way may still take others.
  int round = 2;
  for (; round < 200 && source.foreign() < 10; ++round) {
    send(round);
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_GE(source.foreign(), 10U);
  source.stop();
  const std::vector<int> last = reader.get();
  EXPECT_LT(last[0], 5) << "the other sensor's packets came on";
  EXPECT_GT(last[1], round - 5);
  EXPECT_THROW(source.set_source_address("os-1"), InputError);
}

TEST(UdpSource, OtherSendersAreCountedAndDropped) {
  UdpSourceOptions options = any_port();
  options.source_address = "192.0.2.1";
  UdpSource source(options);
  const UdpSender sender;
  ASSERT_TRUE(sender.send(source.lidar_port(), payload(48, 1)));
  EXPECT_EQ(first_byte(source), std::nullopt);
  EXPECT_EQ(source.foreign(), 1U);
  source.set_source_address("");
  ASSERT_TRUE(sender.send(source.lidar_port(), payload(48, 2)));
  EXPECT_EQ(first_byte(source), 2);
  EXPECT_EQ(source.foreign(), 1U);
}

TEST(UdpSource, PortInUseIsNamed) {
  const UdpSource holder(any_port());
  UdpSourceOptions options = any_port();
  options.lidar_port = holder.lidar_port();
  const std::string port = std::to_string(holder.lidar_port());
  EXPECT_THAT([&] { UdpSource second(options); },
              ThrowsMessage<InputError>(AllOf(
                  HasSubstr("port " + port + " is held by another program"), HasSubstr("ss -ulnp"),
                  HasSubstr("another port"), HasSubstr("bind address"))));
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
  options.bind_address = "fe80::1%nosuch0";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("names an interface that is none")));
  options.bind_address = "";
  options.multicast_group = "192.0.2.1";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("multicast group 192.0.2.1 is none")));
  options.multicast_group = "ff05::7";
  options.bind_address = "127.0.0.1";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("different families")));
  options.bind_address = options.multicast_group = "";
  options.source_address = "1.2.3";
  EXPECT_THAT([&] { UdpSource source(options); },
              ThrowsMessage<InputError>(HasSubstr("source address 1.2.3")));
}

TEST(UdpSource, BoundToOneAddressItReceivesThere) {
  UdpSourceOptions options = any_port();
  options.bind_address = "127.0.0.1";
  UdpSource source(options);
  ASSERT_TRUE(UdpSender().send(source.lidar_port(), payload(48, 3)));
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
  const UdpSender sender;
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
