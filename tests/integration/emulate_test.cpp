// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// `glint emulate` puts a capture's packets on the wire unchanged, in order and at their time.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <future>
#include <random>
#include <stdexcept>

#include "driver/core/test_sensor.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/test_capture.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint {
namespace {

/// A UDP socket on a free port of the loopback interface.
class Listener {
 public:
  explicit Listener(int family) : socket_(socket(family, SOCK_DGRAM, 0)) {
    const timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    const int buffer_bytes = 4 << 20;
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof(buffer_bytes));
    sockaddr_storage address{};
    socklen_t size = sizeof(sockaddr_in6);
    address.ss_family = static_cast<sa_family_t>(family);
    if (family == AF_INET6) {
      reinterpret_cast<sockaddr_in6*>(&address)->sin6_addr = in6addr_loopback;
    } else {
      size = sizeof(sockaddr_in);
      reinterpret_cast<sockaddr_in*>(&address)->sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    }
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0) {
      throw std::runtime_error("no loopback address of this family");
    }
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(reinterpret_cast<sockaddr_in*>(&address)->sin_port);  // The same place in both.
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] std::string port() const { return std::to_string(port_); }
  /// The next datagram; empty if none comes.
  [[nodiscard]] test::Bytes receive() const {
    test::Bytes bytes(65536);
    const ssize_t size = recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

class EmulateTest : public ::testing::Test {
 protected:
  /// A scan over 320 ms, and as many IMU packets, each different.
  EmulateTest() {
    std::ofstream(meta_) << to_metadata_json(info_);
    std::mt19937 random(5);
    lidar_ = test::encode(info_, test::random_scan(info_, 9, random));
    CaptureWriter writer(capture_);
    std::int64_t time_ns = 1'700'000'000'000'000'000;
    for (const test::Bytes& packet : lidar_) {
      imu_.emplace_back(kLegacyImuPacketBytes, static_cast<std::byte>(imu_.size()));
      writer.write({time_ns}, test::sender(), test::receiver(), packet);
      Endpoint imu_port = test::receiver();
      imu_port.port = 7503;
      writer.write({time_ns}, test::sender(), imu_port, imu_.back());
      time_ns += 10'000'000;
    }
    writer.finish();
  }

  /// Runs the command while both ports are read; what it printed, and how long it took.
  void run(int family, const std::string& host, const std::string& rate) {
    const Listener lidar(family);
    const Listener imu(family);
    const auto start = std::chrono::steady_clock::now();
    auto command = std::async(std::launch::async, [&] {
      return test::run_glint({"emulate", capture_, "--meta", meta_, "--to",
                              host + ":" + lidar.port(), "--imu-port", imu.port(), "--rate", rate});
    });
    for (std::size_t i = 0; i < lidar_.size(); ++i) {
      ASSERT_EQ(lidar.receive(), lidar_[i]) << "lidar packet " << i;
      ASSERT_EQ(imu.receive(), imu_[i]) << "IMU packet " << i;
    }
    result_ = command.get();
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(result_.exit_code, 0) << result_.out;
  }

  const SensorInfo info_ = test::make_sensor(LidarProfile::kLegacy, 16, 512);
  const test::TempDir dir_;
  const std::filesystem::path capture_ = dir_ / "capture.pcap";
  const std::filesystem::path meta_ = dir_ / "capture.json";
  std::vector<test::Bytes> lidar_;
  std::vector<test::Bytes> imu_;
  test::CommandResult result_;
  double seconds_ = 0.0;
};

TEST_F(EmulateTest, PacketsArriveUnchangedInOrderAndPaced) {
  run(AF_INET, "127.0.0.1", "1");
  EXPECT_GE(seconds_, 0.310);
  EXPECT_THAT(result_.out, ::testing::HasSubstr("sent 32 lidar packets"));
  EXPECT_THAT(result_.out, ::testing::HasSubstr("32 IMU packets"));
}

TEST_F(EmulateTest, Ipv6TargetsAreSentTo) {
  try {
    const Listener probe(AF_INET6);
  } catch (const std::runtime_error& error) {
    GTEST_SKIP() << error.what();
  }
  run(AF_INET6, "[::1]", "10");
}

TEST_F(EmulateTest, NobodyListeningIsNoError) {
  const auto result =
      test::run_glint({"emulate", capture_, "--to", "127.0.0.1:9", "--rate", "max"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
}

}  // namespace
}  // namespace glint
