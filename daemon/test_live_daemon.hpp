// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "daemon/api.hpp"
#include "daemon/client.hpp"
#include "daemon/runtime.hpp"
#include "daemon/sensor_link.hpp"
#include "daemon/server.hpp"
#include "daemon/steady_clock.hpp"
#include "daemon/test_room.hpp"
#include "driver/emulator/sensor_emulator.hpp"
#include "driver/udp_source.hpp"
#include "tests/support/slow_build.hpp"

namespace glint::test {

/// Sends what a sensor in the room sends, back and forth through a few scans, as long as it is
/// streaming to this machine. Thread-safe.
class RoomStreamer {
 public:
  RoomStreamer() : thread_([this] { run(); }) {}
  ~RoomStreamer() {
    change([&] { stopped_ = true; });
    thread_.join();
  }
  RoomStreamer(const RoomStreamer&) = delete;
  RoomStreamer& operator=(const RoomStreamer&) = delete;

  void set_sensor(SensorInfo info) {
    std::vector<LidarScan> scans;
    for (int k = 0; k < kScans; ++k) scans.push_back(room_scan(info, k));
    change([&] {
      info_ = std::move(info);
      scans_ = std::move(scans);
    });
  }
  void set_stream(const emulator::EmulatedStream& stream) {
    change([&] { stream_ = stream; });
  }
  /// Packets vanish on their way from here on, or do so no more.
  void set_muted(bool muted) {
    change([&] { muted_ = muted; });
  }

 private:
  static constexpr int kScans = 6;
  static constexpr std::chrono::milliseconds kPeriod{30 * kSlowdown};

  template <class Change>
  void change(Change apply) {
    const std::lock_guard lock(mutex_);
    apply();
    changed_.notify_all();
  }

  void run() {
    std::unique_lock lock(mutex_);
    while (!stopped_) {
      if (stream_.sending && stream_.destination == "127.0.0.1" && !muted_) send_scan();
      changed_.wait_for(lock, kPeriod, [&] { return stopped_; });
    }
  }

  void send_scan() {
    SensorInfo info = info_;
    info.init_id = stream_.init_id;
    const int step = count_ % (2 * kScans - 2);
    LidarScan& scan = scans_[static_cast<std::size_t>(std::min(step, 2 * kScans - 2 - step))];
    scan.frame_id = static_cast<std::uint16_t>(count_);
    for (int m = 0; m < info.columns_per_frame; ++m) {
      scan.column_time[static_cast<std::size_t>(m)] = nominal_time(info, count_, m);
    }
    ++count_;
    using boost::asio::ip::udp;
    const udp::endpoint target(boost::asio::ip::address_v4::loopback(),
                               static_cast<std::uint16_t>(stream_.lidar_port));
    for (const Bytes& packet : encode(info, scan)) {
      boost::system::error_code ignored;
      socket_.send_to(boost::asio::buffer(packet), target, 0, ignored);
    }
  }

  boost::asio::io_context io_;
  boost::asio::ip::udp::socket socket_{io_, boost::asio::ip::udp::v4()};
  std::mutex mutex_;
  std::condition_variable changed_;
  SensorInfo info_;
  std::vector<LidarScan> scans_;
  emulator::EmulatedStream stream_;
  int count_ = 0;
  bool muted_ = false;
  bool stopped_ = false;
  std::thread thread_;  ///< Last: it uses all of the above.
};

/// Everything of glintd but the process, and an emulated sensor that it talks to over loopback; the
/// sensor is a hundred times as fast as a real one, and so are the session's waits.
class LiveDaemon {
 public:
  /// Metadata with settings, as the sensor in the room has them in its flash.
  static nlohmann::json metadata(const SensorInfo& info, const nlohmann::json& settings = {}) {
    auto json = nlohmann::json::parse(to_metadata_json(info));
    json["config_params"]["udp_dest"] = "127.0.0.9";
    if (settings.is_object()) json["config_params"].update(settings);
    return json;
  }

  LiveDaemon() {
    UdpSourceOptions udp;
    udp.bind_address = "127.0.0.1";
    udp.lidar_port = 0;
    udp.imu_port = 0;
    source_ = std::make_unique<UdpSource>(udp);
    port_ = source_->lidar_port();
    config_.server.listen = "127.0.0.1:0";
    // Enough for the room, and quick in a slow build.
    config_.slam.orb_features = 300;
    config_.slam.match_max = 60;
    config_.slam.planes = config_.slam.ba = config_.slam.loops = false;
    emulator_options_.sensor.reinitialise_ns = 20 * kMs_ns;
    emulator_options_.sensor.boot_ns = 30 * kMs_ns;
    streamer_.set_sensor(room_sensor());
    set_flash(metadata(room_sensor()));
  }
  ~LiveDaemon() {
    if (thread_.joinable()) {
      in_loop([&] {
        server_->close();
        io_.stop();
      });
      thread_.join();
    }
    link_.reset();
    if (runtime_) runtime_->stop();
  }
  LiveDaemon(const LiveDaemon&) = delete;
  LiveDaemon& operator=(const LiveDaemon&) = delete;

  // Before start().
  daemon::Config& config() { return config_; }
  emulator::SensorEmulatorOptions& emulator_options() { return emulator_options_; }
  void set_flash(const nlohmann::json& metadata) {
    emulator_options_.sensor.metadata_json = metadata.dump();
  }
  /// Settings of a sensor that sends here already.
  [[nodiscard]] nlohmann::json sends_here() const {
    return {{"udp_dest", "127.0.0.1"}, {"udp_port_lidar", port_}, {"udp_port_imu", port_}};
  }
  [[nodiscard]] std::uint16_t udp_port() const { return port_; }

  void start(const std::optional<SensorInfo>& metadata_file = std::nullopt) {
    make_emulator();
    config_.sensor.host = "127.0.0.1:" + std::to_string(emulator_->http_port());
    runtime_ = std::make_unique<daemon::Runtime>(metadata_file, config_, std::move(source_),
                                                 daemon::RuntimeOptions{});
    api_ = std::make_unique<daemon::Api>(io_, *runtime_, config_);
    server_ = std::make_unique<daemon::Server>(io_, *api_, config_);
    tcp_port_ = server_->tcp_port();
    link_ = std::make_unique<daemon::SensorLink>(io_, *runtime_, link_options(!metadata_file));
    api_->set_sensor(*link_);
    runtime_->start([this](const auto& snapshot) { server_->publish(snapshot); });
    server_->start();
    thread_ = std::thread([this] { io_.run(); });
  }

  /// Runs something on the thread of sensor and session.
  template <class Function, class Result = std::invoke_result_t<Function>>
  Result in_loop(Function function) {
    std::packaged_task<Result()> task(std::move(function));
    auto result = task.get_future();
    boost::asio::post(io_, [&task] { task(); });
    return result.get();
  }
  void power_on() {
    in_loop([&] { emulator_->power_on(); });
  }
  void restart_sensor() {
    in_loop([&] { emulator_->restart(); });
  }
  void raise_alert(const std::string& id, const std::string& category, const std::string& message) {
    in_loop([&] { emulator_->raise_alert(id, category, message); });
  }
  /// The sensor is set to another mode by others, which makes it restart; its packets come before
  /// it answers questions.
  void replace_sensor(const SensorInfo& info, const nlohmann::json& metadata) {
    in_loop([&] {
      emulator_options_.http_port = emulator_->http_port();
      emulator_options_.tcp_port = emulator_->tcp_port();
      emulator_options_.sensor.first_init_id = emulator_->sensor().stream().init_id + 100;
      set_flash(metadata);
      emulator_.reset();
      streamer_.set_stream({});
    });
    streamer_.set_sensor(info);
    in_loop([&] {
      make_emulator();
      emulator_->inject({emulator::ControlFault::kSlow, 1, {}});
    });
  }
  emulator::EmulatorCounts sensor_counts() {
    return in_loop([&] { return emulator_->sensor().counts(); });
  }
  nlohmann::json sensor_settings() {
    return in_loop([&] { return emulator_->sensor().config().active(); });
  }
  RoomStreamer& streamer() { return streamer_; }
  daemon::Runtime& runtime() { return *runtime_; }

  daemon::Json status() { return daemon::Client(address()).call("get_status"); }
  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(tcp_port_); }
  /// Polls get_status until `done(result)`; the last one when it never was, after ten seconds (more
  /// in a slow build).
  template <class Done>
  testing::AssertionResult reaches(Done done) {
    daemon::Client client(address());
    daemon::Json last;
    for (int i = 0; i < 1000 * kSlowdown; ++i) {
      last = client.call("get_status");
      if (done(last)) return testing::AssertionSuccess();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return testing::AssertionFailure() << last.dump(1);
  }

 private:
  static constexpr std::int64_t kMs_ns = 1'000'000;

  void make_emulator() {
    emulator_.emplace(
        io_, emulator_options_, daemon::stage_clock(),
        [this](const emulator::EmulatedStream& stream) { streamer_.set_stream(stream); });
  }

  daemon::SensorLinkOptions link_options(bool take_metadata) {
    daemon::SensorLinkOptions options = daemon::sensor_link_options(config_.sensor, {port_, port_});
    options.take_metadata = take_metadata;
    options.address.tcp_port = emulator_->tcp_port();
    options.timeouts = {std::chrono::milliseconds(200), std::chrono::milliseconds(200)};
    SessionTimes& times = options.session.times;
    times.first_retry_ns = 5 * kMs_ns;
    times.longest_retry_ns = 50 * kMs_ns;
    times.initialising_poll_ns = 5 * kMs_ns;
    times.first_packet_limit_ns = 500 * kMs_ns;
    times.reconfigure_ns = 100 * kMs_ns;
    times.health_period_ns = 50 * kMs_ns;
    times.packet_look_ns = 10 * kMs_ns;
    return options;
  }

  daemon::Config config_;
  emulator::SensorEmulatorOptions emulator_options_;
  boost::asio::io_context io_{1};
  RoomStreamer streamer_;
  std::optional<emulator::SensorEmulator> emulator_;
  std::unique_ptr<UdpSource> source_;
  std::uint16_t port_ = 0;
  std::unique_ptr<daemon::Runtime> runtime_;
  std::unique_ptr<daemon::Api> api_;
  std::unique_ptr<daemon::Server> server_;
  std::unique_ptr<daemon::SensorLink> link_;
  std::uint16_t tcp_port_ = 0;
  std::thread thread_;
};

}  // namespace glint::test
