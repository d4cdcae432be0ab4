// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The way of a live packet from the socket to odometry's hands: what it allocates, and what it
// costs. On its own, for it replaces the allocator's entry points.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <thread>

#include "daemon/receive_thread.hpp"
#include "daemon/steady_clock.hpp"
#include "driver/test_udp.hpp"
#include "tests/support/alloc_counter.hpp"

namespace glint::daemon {
namespace {

using test::payload;
using test::UdpSender;

// 64 beams by 1024 columns at 10 Hz in the legacy profile.
constexpr std::size_t kLidarBytes = 12'608;
constexpr std::size_t kImuBytes = 48;
constexpr std::int64_t kLidarPeriodNs = kNsPerSecond / 640;
constexpr std::size_t kCapacity = 1280;

/// A socket, the receive thread and the queue, as in glintd.
class ReceivePath : public testing::Test {
 protected:
  ReceivePath() { crossings_.expected.silence_ns = kNsPerSecond; }
  ~ReceivePath() override {
    source_.stop();
    thread_.join();
  }

  BoundedQueue<ReceivedPacket>::PopResult pop() {
    return crossings_.packets.pop(popped_, std::chrono::milliseconds(2000));
  }
  using PopResult = BoundedQueue<ReceivedPacket>::PopResult;

  UdpSource source_{test::any_port()};
  Crossings crossings_{kCapacity};
  Heartbeat heartbeat_;
  ReceiveThread receive_{source_, false, crossings_, heartbeat_};
  ReceivedPacket popped_;
  std::thread thread_{[this] { receive_.run(); }};
};

TEST_F(ReceivePath, PacketsGoFromSocketToOdometryWithoutAllocation) {
  if (!test::heap_allocations_are_counted()) GTEST_SKIP() << "not counted under a sanitizer";
  const UdpSender sender;
  const auto lidar = payload(kLidarBytes, 1);
  const auto imu = payload(kImuBytes, 2);
  // Bursts of both kinds, as deep as any before.
  const auto send_and_pop = [&](int rounds) {
    for (int round = 0; round < rounds; ++round) {
      for (int i = 0; i < 40; ++i) {
        const bool is_imu = i % 7 == 6;
        if (!sender.send(source_.lidar_port(), is_imu ? imu : lidar)) return false;
      }
      for (int i = 0; i < 40; ++i) {
        if (pop() != PopResult::kItem) return false;
        if (popped_.packet.bytes.size() != (i % 7 == 6 ? kImuBytes : kLidarBytes)) return false;
      }
    }
    return true;
  };
  ASSERT_TRUE(send_and_pop(100));
  const std::uint64_t before = test::heap_allocations();
  ASSERT_TRUE(send_and_pop(250));
  // On a busy machine the queue may get deeper than before, which makes buffers once: at most one
  // for each packet of a burst.
  EXPECT_LE(test::heap_allocations() - before, 40U) << "in 10,000 packets";
}

TEST_F(ReceivePath, APacketThatComesAloneIsHandedOverAtOnce) {
  const UdpSender sender;
  std::int64_t least_ns = kNsPerSecond;
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const std::int64_t start_ns = steady_now_ns();
    ASSERT_TRUE(sender.send(source_.lidar_port(), payload(kLidarBytes, i)));
    ASSERT_EQ(pop(), PopResult::kItem);
    least_ns = std::min(least_ns, steady_now_ns() - start_ns);
    EXPECT_NEAR(static_cast<double>(popped_.arrival_ns - start_ns), 0, 1e9);
  }
  EXPECT_LT(least_ns, 1'000'000);
}

/// A process that sends as a sensor does, at its pace, until it is destroyed.
class SensorProcess {
 public:
  explicit SensorProcess(std::uint16_t port) : pid_(fork()) {
    if (pid_ == 0) send_for_ever(port);
  }
  ~SensorProcess() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  SensorProcess(const SensorProcess&) = delete;
  SensorProcess& operator=(const SensorProcess&) = delete;

 private:
  [[noreturn]] static void send_for_ever(std::uint16_t port) {
    const UdpSender sender;
    const auto packet = payload(kLidarBytes, 1);
    timespec due{};
    clock_gettime(CLOCK_MONOTONIC, &due);
    for (;;) {
      due.tv_nsec += kLidarPeriodNs;
      due.tv_sec += due.tv_nsec / kNsPerSecond;
      due.tv_nsec %= kNsPerSecond;
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
      sender.send(port, packet);
    }
  }

  const pid_t pid_;
};

TEST_F(ReceivePath, TakesUnderTwoPercentOfACore) {
  if (!test::heap_allocations_are_counted()) GTEST_SKIP() << "not measured under a sanitizer";
  clockid_t clock{};
  ASSERT_EQ(pthread_getcpuclockid(thread_.native_handle(), &clock), 0);
  const SensorProcess sensor(source_.lidar_port());
  double least = 1.0;
  std::uint64_t packets = 0;
  // The least of several spells: other programs may cost this one its caches, not spare it work.
  for (int spell = 0; spell < 3; ++spell) {
    const std::int64_t cpu_ns = read_clock_ns(clock);
    const std::int64_t start_ns = steady_now_ns();
    for (int i = 0; i < 640; ++i) {
      ASSERT_EQ(pop(), PopResult::kItem);
      ASSERT_EQ(popped_.packet.bytes.size(), kLidarBytes);
    }
    packets += 640;
    // Of the time that the packets stand for, whatever hurry or delay they came with.
    least = std::min(least, static_cast<double>(read_clock_ns(clock) - cpu_ns) /
                                static_cast<double>(640 * kLidarPeriodNs));
    EXPECT_LT(steady_now_ns() - start_ns, 10 * kNsPerSecond);
  }
  RecordProperty("receive_thread_percent", std::to_string(100 * least));
  printf("receive thread: %.2f %% of a core at 10 Hz (640 packets/s), %.1f us a packet\n",
         100 * least, 1e6 * least / 640);
  EXPECT_LT(least, 0.02) << "over " << packets << " packets";
  EXPECT_EQ(source_.kernel_drops(), 0U);
}

}  // namespace
}  // namespace glint::daemon
