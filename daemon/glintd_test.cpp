// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The process: options, exit codes, sentences, signals, notification. GLINTD names the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "daemon/client.hpp"
#include "daemon/test_glintd.hpp"
#include "driver/test_udp.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// A UDP port of this machine, held as long as this lives.
class HeldPort {
 public:
  HeldPort() : socket_(::socket(AF_INET6, SOCK_DGRAM, 0)) {
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    socklen_t size = sizeof address;
    void* generic = &address;
    if (bind(socket_, static_cast<sockaddr*>(generic), size) == 0) {
      getsockname(socket_, static_cast<sockaddr*>(generic), &size);
    }
    port_ = ntohs(address.sin6_port);
  }
  ~HeldPort() { release(); }
  HeldPort(const HeldPort&) = delete;
  HeldPort& operator=(const HeldPort&) = delete;
  void release() { close(std::exchange(socket_, -1)); }
  [[nodiscard]] std::string text() const { return std::to_string(port_); }

 private:
  int socket_;
  int port_ = 0;
};

TEST_F(GlintdTest, ServesACaptureToItsEndAndStopsCleanly) {
  Process process(serve_capture(4), directory_);
  const Json status = poll_status(
      [](const Json& s) { return s["sensor_state"] == "ENDED" && s["counters"]["poses"] == 4; });
  ASSERT_FALSE(status.is_null()) << process.log();
  EXPECT_EQ(status["counters"]["missing_packets"], 0);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_THAT(process.log(), HasSubstr("stopped after 4 poses"));
  EXPECT_FALSE(fs::exists(socket()));
  const fs::path session = status["session_file"].get<std::string>();
  EXPECT_TRUE(fs::exists(session));
  EXPECT_FALSE(fs::exists(session.string() + "-wal"));
}

TEST_F(GlintdTest, OldSessionsMakeRoomAtStartAndSavedMapsStay) {
  auto arguments = serve_capture(2);
  arguments.insert(arguments.end(), {"--set", "state.max_sessions_mb=1"});
  const fs::path state = directory_ / "state";
  fs::create_directories(state / "maps");
  const std::string content(700'000, 'x');
  const auto now = fs::file_time_type::clock::now();
  for (const int age_h : {3, 2, 1}) {
    const fs::path file = state / ("session-2026010" + std::to_string(9 - age_h) + ".glint");
    std::ofstream(file) << content;
    fs::last_write_time(file, now - std::chrono::hours(age_h));
    std::ofstream(state / "maps" / file.filename()) << content;
  }
  Process process(arguments, directory_);
  const Json status = poll_status([](const Json& s) { return s["counters"]["poses"] == 2; });
  ASSERT_FALSE(status.is_null()) << process.log();
  EXPECT_EQ(status["counters"]["sessions_removed"], 2);
  EXPECT_FALSE(fs::exists(state / "session-20260106.glint"));
  EXPECT_FALSE(fs::exists(state / "session-20260107.glint"));
  EXPECT_TRUE(fs::exists(state / "session-20260108.glint"));
  EXPECT_TRUE(fs::exists(status["session_file"].get<std::string>()));
  EXPECT_EQ(std::distance(fs::directory_iterator(state / "maps"), {}), 3);
  EXPECT_THAT(process.log(), AllOf(HasSubstr("removed the old session session-20260106.glint"),
                                   HasSubstr("removed the old session session-20260107.glint")));
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
}

TEST_F(GlintdTest, StoppingWhileAMapIsSavedLeavesAWholeOneOrNone) {
  Process process(serve_capture(4), directory_);
  ASSERT_FALSE(poll_status([](const Json& s) {
                 return s["map"]["keyframes"] > 0 && s["counters"]["poses"] == 4;
               }).is_null())
      << process.log();
  {
    Client client(socket());
    EXPECT_EQ(client.call("save_map", {{"name", "office"}})["accepted"], true);
  }
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  const fs::path maps = directory_ / "state" / "maps";
  for (const auto& entry : fs::directory_iterator(directory_ / "state")) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
  if (!fs::exists(maps / "office.glint")) {
    EXPECT_TRUE(!fs::exists(maps) || fs::is_empty(maps));
  } else {
    EXPECT_GT(slam::SessionReader(maps / "office.glint").keyframe_count(), 0U);
  }
}

TEST_F(GlintdTest, TwoSensorsOnOnePortReachTheirOwnDaemonsOnly) {
  const SensorInfo info = test::room_sensor();
  const fs::path metadata = directory_ / "room.json";
  std::ofstream(metadata) << to_metadata_json(info);
  const std::uint16_t port = test::free_port();
  const auto serve = [&](const std::string& name, const std::string& sensor) {
    fs::create_directories(directory_ / name);
    return std::vector<std::string>{"--meta", metadata.string(),  //
                                    "--set",  "server.listen=",
                                    "--set",  "server.unix_socket=" + socket() + name,
                                    "--set",  "state.directory=",
                                    "--set",  "sensor.lidar_port=" + std::to_string(port),
                                    "--set",  "sensor.imu_port=" + std::to_string(port),
                                    "--set",  "sensor.bind_address=" + name,
                                    "--set",  "sensor.source_address=" + sensor};
  };
  Process first(serve("127.0.0.4", "127.0.0.2"), directory_ / "127.0.0.4");
  Process second(serve("127.0.0.5", "127.0.0.3"), directory_ / "127.0.0.5");
  const auto any = [](const Json&) { return true; };
  ASSERT_FALSE(poll_status(any, socket() + "127.0.0.4").is_null()) << first.log();
  ASSERT_FALSE(poll_status(any, socket() + "127.0.0.5").is_null()) << second.log();

  // Both sensors send to both, the second one scan less.
  const test::UdpSender two("127.0.0.2");
  const test::UdpSender three("127.0.0.3");
  const std::vector<test::Bytes> packets = test::room_packets(info, 4);
  const std::size_t fewer = packets.size() * 3 / 4;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    for (const char* to : {"127.0.0.4", "127.0.0.5"}) {
      ASSERT_TRUE(two.send(to, port, packets[i]));
      ASSERT_TRUE(i >= fewer || three.send(to, port, packets[i]));
    }
  }
  const auto counts = [&](std::size_t own, std::size_t foreign) {
    return [=](const Json& status) {
      return status["counters"]["lidar_packets"] == own &&
             status["counters"]["foreign_packets"] == foreign;
    };
  };
  EXPECT_FALSE(poll_status(counts(packets.size(), fewer), socket() + "127.0.0.4").is_null());
  EXPECT_FALSE(poll_status(counts(fewer, packets.size()), socket() + "127.0.0.5").is_null());

  auto third = serve("127.0.0.4", "127.0.0.2");
  third[5] += "b";
  EXPECT_EQ(exit_code(third), 1);
  EXPECT_THAT(log_, AllOf(HasSubstr("port " + std::to_string(port) + " is held"),
                          HasSubstr("bind address")));
  third.insert(third.end(), {"--set", "sensor.multicast_group=192.0.2.1"});
  EXPECT_EQ(exit_code(third), 78);
  EXPECT_THAT(log_, HasSubstr("cannot be '192.0.2.1'; it must be an address of a multicast group"));
}

TEST_F(GlintdTest, ServesBeforeItsSensorHasPower) {
  HeldPort port;
  const auto arguments = await_sensor(port.text());
  EXPECT_EQ(exit_code(arguments), 1) << "the port is held";
  EXPECT_THAT(log_, HasSubstr("port " + port.text() + " is held by another program"));
  port.release();
  Process process(arguments, directory_);
  const Json status =
      poll_status([](const Json& s) { return s["sensor_session"]["failures"] > 0; });
  ASSERT_FALSE(status.is_null()) << process.log();
  EXPECT_EQ(status["state"], "INIT");
  EXPECT_EQ(status["sensor_state"], "DISCOVERING");
  EXPECT_THAT(status["sensor_session"]["failure"].get<std::string>(),
              HasSubstr("127.0.0.1 refuses connections on port 1"));
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_THAT(process.log(), AllOf(HasSubstr("127.0.0.1 refuses connections on port 1"),
                                   HasSubstr("stopped after 0 poses")));
}

TEST_F(GlintdTest, WhatTheCaptureSaysAtItsEndIsLogged) {
  auto arguments = serve_capture(2);
  const fs::path capture = directory_ / "room.pcap";
  fs::resize_file(capture, fs::file_size(capture) - 100);
  Process process(arguments, directory_);
  ASSERT_FALSE(poll_status([](const Json& s) { return s["sensor_state"] == "ENDED"; }).is_null());
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_THAT(process.log(), HasSubstr("breaks off"));
}

TEST_F(GlintdTest, ReloadTellsWhatItCannotChange) {
  const fs::path config = directory_ / "glint.toml";
  std::ofstream(config) << "[log]\nlevel = \"info\"\n";
  auto arguments = serve_capture(1);
  arguments.insert(arguments.end(), {"--config", config.string()});
  Process process(arguments, directory_);
  ASSERT_FALSE(poll_status([](const Json&) { return true; }).is_null()) << process.log();
  std::ofstream(config) << "[log]\nlevel = \"info\"\n[slam]\norb_features = 500\n";
  fs::create_directory(config.string() + ".d");
  std::ofstream(config.string() + ".d/50-loud.toml") << "[log]\nlevel = \"debug\"\n";
  process.signal(SIGHUP);
  for (int i = 0; i < 500 && process.log().find("log.level is debug") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_THAT(process.log(), AllOf(HasSubstr("/slam/orb_features = 500 takes effect at the next"),
                                   HasSubstr("log.level is debug")));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 0);
}

TEST_F(GlintdTest, AddressesThatNoWaitingMakesRightExitWith78) {
  const fs::path metadata = directory_ / "room.json";
  std::ofstream(metadata) << to_metadata_json(test::room_sensor());
  const auto with = [&](const std::string& setting) {
    return exit_code({"--meta", metadata.string(), "--set", setting, "--set", "server.listen=",
                      "--set", "server.unix_socket=" + socket(), "--set", "state.directory="});
  };
  EXPECT_EQ(with("sensor.bind_address=eth0"), 78);
  EXPECT_EQ(with("sensor.multicast_group=192.0.2.1"), 78);
  EXPECT_EQ(with("sensor.bind_address=192.0.2.77"), 1) << "its interface may come up later";
}

TEST_F(GlintdTest, BadConfigurationsExitWith78AndASentence) {
  EXPECT_EQ(exit_code({"--set", "slam.orb_feature=1", "--check-config"}), 78);
  EXPECT_THAT(log_, HasSubstr("slam.orb_features"));
  EXPECT_EQ(exit_code({"--config", "/nonexistent.toml"}), 78);
  EXPECT_THAT(log_, HasSubstr("/nonexistent.toml"));
  EXPECT_EQ(exit_code({"--config", "/dev/null"}), 78) << "a live source without metadata";
  EXPECT_THAT(log_, AllOf(HasSubstr("sensor.host"), HasSubstr("sensor.metadata_file")));
  EXPECT_EQ(exit_code({"--config", "/dev/null", "--check-config", "--set", "sensor.host=h", "--set",
                       "sensor.azimuth_window_mdeg=[0, 360]"}),
            78);
  EXPECT_THAT(log_, HasSubstr("[0, 360000]"));
  EXPECT_EQ(exit_code({"--source", "pcap:/nonexistent.pcap"}), 78);
  EXPECT_EQ(exit_code({"--source", "tape"}), 78);
  auto arguments = serve_capture(1);
  arguments.back() = "state.directory=/proc/glint";
  EXPECT_EQ(exit_code(arguments), 78);
  EXPECT_THAT(log_, HasSubstr("state.directory"));
  EXPECT_EQ(exit_code({"--no-such-option"}), 2);
}

TEST_F(GlintdTest, AGoodConfigurationIsSaidToBeGood) {
  EXPECT_EQ(exit_code({"--config", "/dev/null", "--check-config"}), 0);
}

TEST_F(GlintdTest, ASocketInUseExitsWith1AndNamesTheKey) {
  const auto arguments = serve_capture(1);
  Process first(arguments, directory_);
  ASSERT_FALSE(poll_status([](const Json&) { return true; }).is_null()) << first.log();
  EXPECT_EQ(exit_code(arguments), 1);
  EXPECT_THAT(log_, HasSubstr("server.unix_socket"));
  EXPECT_FALSE(poll_status([](const Json&) { return true; }).is_null()) << "the first one lives";
}

TEST_F(GlintdTest, ADirectoryThatTakesNoFileCostsTheSessionAndNotThePose) {
  auto arguments = serve_capture(3);
  // Not even root makes files there.
  arguments.insert(arguments.end(), {"--set", "state.directory=/proc"});
  const Process process(arguments, directory_);
  const Json status = poll_status([](const Json& s) { return s["counters"]["scans"] == 3; });
  ASSERT_FALSE(status.is_null()) << process.log();
  EXPECT_EQ(status["counters"]["store_failures"], 1);
  EXPECT_THAT(status["store_error"], HasSubstr("/proc/session-"));
  EXPECT_THAT(process.log(), HasSubstr("no session is kept: cannot create the session file"));
}

TEST_F(GlintdTest, AReloadTakesTheTokensThatAreInTheFileThen) {
  const std::filesystem::path tokens = directory_ / "tokens";
  std::ofstream(tokens) << "0123456789abcdef\n";
  auto arguments = serve_capture(1);
  arguments.insert(arguments.end(), {"--set", "server.read_token_file=" + tokens.string(), "--set",
                                     "server.require_token=true"});
  const Process process(arguments, directory_);
  const auto is_let_in = [&](const std::string& token) {
    try {
      return Client(socket(), {"", token}).call("get_status").contains("state");
    } catch (const ClientError&) {
      return false;
    }
  };
  const auto is_let_in_soon = [&](const std::string& token) {
    for (int i = 0; i < 10; ++i) {
      if (is_let_in(token)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    return false;
  };
  ASSERT_TRUE(is_let_in_soon("0123456789abcdef")) << process.log();
  std::ofstream(tokens) << "fedcba9876543210\n";
  process.signal(SIGHUP);
  EXPECT_TRUE(is_let_in_soon("fedcba9876543210")) << process.log();
  EXPECT_FALSE(is_let_in("0123456789abcdef"));
}

TEST_F(GlintdTest, CountersAreToldOnStandardErrorWhereThatIsNotTheJournal) {
  auto arguments = serve_capture(1);
  arguments.insert(arguments.end(), {"--set", "state.directory=/proc"});
  // Inherited from a service that started this one with its output elsewhere.
  setenv("JOURNAL_STREAM", "1:1", 1);
  const Process process(arguments, directory_);
  for (int i = 0; i < 500 && process.log().find("failed writes") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_THAT(process.log(), HasSubstr("warning: 1 failed writes of the session file"));
}

TEST_F(GlintdTest, SystemdIsToldReadyThenFedThenStopping) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (directory_ / "notify").string();
  ASSERT_LT(path.size(), sizeof address.sun_path);
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const int notify = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  const void* generic = &address;
  ASSERT_EQ(bind(notify, static_cast<const sockaddr*>(generic), sizeof address), 0);
  const timeval limit{5, 0};
  setsockopt(notify, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  const auto arguments = serve_capture(1);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  setenv("WATCHDOG_USEC", "400000", 1);
  Process process(arguments, directory_);

  std::string all;
  const auto wait_for = [&](const std::string& what) {
    std::array<char, 4096> buffer{};
    while (all.find(what) == std::string::npos) {
      const ssize_t size = recv(notify, buffer.data(), buffer.size(), 0);
      if (size <= 0) return false;
      all.append(buffer.data(), static_cast<std::size_t>(size)).append("\n");
    }
    return true;
  };
  EXPECT_TRUE(wait_for("READY=1")) << all;
  all.clear();
  EXPECT_TRUE(wait_for("WATCHDOG=1")) << all;
  all.clear();
  EXPECT_TRUE(wait_for("WATCHDOG=1")) << all;
  EXPECT_TRUE(wait_for("STATUS=")) << all;
  process.signal(SIGTERM);
  EXPECT_TRUE(wait_for("STOPPING=1")) << all;
  EXPECT_EQ(process.wait(), 0);
  close(notify);
}

}  // namespace
}  // namespace glint::daemon
