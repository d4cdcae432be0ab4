// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "daemon/client.hpp"
#include "daemon/test_room.hpp"
#include "pcap/capture_writer.hpp"

/// glintd as a process of its own; GLINTD names the program.
namespace glint::daemon {

inline std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A glintd on its own, its standard error in a file.
class Process {
 public:
  /// `passed` are listening sockets that it gets as systemd would hand them over.
  Process(std::vector<std::string> arguments, const std::filesystem::path& directory,
          const std::vector<int>& passed = {})
      : log_(directory / "stderr.txt") {
    arguments.insert(arguments.begin(), GLINTD);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    if (std::freopen(log_.c_str(), "w", stderr) == nullptr) _exit(126);
    if (!passed.empty()) pass(passed);
    execv(GLINTD, argv.data());
    _exit(127);
  }
  ~Process() {
    if (pid_ > 0) kill(pid_, SIGKILL);
    if (pid_ > 0) waitpid(pid_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const { kill(pid_, number); }
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string log() const { return read_file(log_); }

 private:
  // In the child: descriptors from 3 on, and who is meant by them, as sd_listen_fds(3) has it.
  static void pass(const std::vector<int>& sockets) {
    constexpr int kAside = 100;
    const int count = static_cast<int>(sockets.size());
    for (int i = 0; i < count; ++i) dup2(sockets[static_cast<std::size_t>(i)], kAside + i);
    for (int i = 0; i < count; ++i) dup2(kAside + i, 3 + i);
    setenv("LISTEN_PID", std::to_string(getpid()).c_str(), 1);
    setenv("LISTEN_FDS", std::to_string(count).c_str(), 1);
  }

  const std::filesystem::path log_;
  pid_t pid_ = -1;
};

/// A test with a directory of its own, of glintd as a program.
class GlintdTest : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = std::filesystem::path(testing::TempDir()) /
                 ("glintd_test_" + std::to_string(getpid()) + "_" +
                  testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(directory_);
    // Free of what the test's own surroundings may have set.
    for (const char* name :
         {"NOTIFY_SOCKET", "STATE_DIRECTORY", "RUNTIME_DIRECTORY", "JOURNAL_STREAM",
          "WATCHDOG_USEC", "WATCHDOG_PID", "LISTEN_PID", "LISTEN_FDS"}) {
      unsetenv(name);
    }
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path write_capture(int scans) {
    const SensorInfo info = test::room_sensor();
    std::ofstream(directory_ / "room.json") << to_metadata_json(info);
    CaptureWriter writer(directory_ / "room.pcap");
    std::int64_t time_ns = 1'000'000'000;
    for (const test::Bytes& packet : test::room_packets(info, scans)) {
      writer.write({time_ns += 3'000'000}, {IpAddress::v4(10, 0, 0, 2), 7502},
                   {IpAddress::v4(10, 0, 0, 1), 7502}, packet);
    }
    writer.finish();
    return directory_ / "room.pcap";
  }

  [[nodiscard]] std::string socket() const { return (directory_ / "g.sock").string(); }

  /// Arguments for a daemon that serves a capture on the Unix socket only.
  std::vector<std::string> serve_capture(int scans) {
    return {"--source", "pcap:" + write_capture(scans).string(),
            "--rate",   "max",
            "--set",    "server.listen=",
            "--set",    "server.unix_socket=" + socket(),
            "--set",    "state.directory=" + (directory_ / "state").string()};
  }

  /// Arguments for a daemon that waits for a sensor where there is none.
  [[nodiscard]] std::vector<std::string> await_sensor(const std::string& port) const {
    return {"--config", "/dev/null",
            "--set",    "sensor.host=127.0.0.1:1",
            "--set",    "sensor.lidar_port=" + port,
            "--set",    "sensor.imu_port=" + port,
            "--set",    "server.listen=",
            "--set",    "server.unix_socket=" + socket(),
            "--set",    "state.directory=" + (directory_ / "state").string()};
  }

  /// The first answer for which `done` holds; null after ten seconds.
  template <class Done>
  Json poll_status(Done done) {
    return poll_status(done, socket());
  }
  template <class Done>
  Json poll_status(Done done, const std::string& address) {
    for (int i = 0; i < 500; ++i) {
      try {
        Client client(address);
        Json status = client.call("get_status");
        if (done(status)) return status;
      } catch (const ClientError&) {
        // Not up yet.
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return nullptr;
  }

  int exit_code(const std::vector<std::string>& arguments) {
    Process process(arguments, directory_);
    const int code = process.wait();
    log_ = process.log();
    return code;
  }

  std::filesystem::path directory_;
  std::string log_;
};

}  // namespace glint::daemon
