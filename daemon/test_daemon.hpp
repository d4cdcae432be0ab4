// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "daemon/api.hpp"
#include "daemon/client.hpp"
#include "daemon/runtime.hpp"
#include "daemon/server.hpp"
#include "daemon/test_room.hpp"

namespace glint::test {

/// A live source that a test feeds. The packets are received evenly in time, as a sensor sends
/// them, from kFakeStart_ns on. Thread-safe.
class FakeSource : public PacketSource {
 public:
  static constexpr std::int64_t kFakeStart_ns = 1'790'000'000'000'000'000;

  explicit FakeSource(std::int64_t packet_gap_ns) : packet_gap_ns_(packet_gap_ns) {}
  void feed(const Bytes& bytes) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(bytes);
    changed_.notify_all();
  }
  SourceStatus read(RawPacket& packet) override {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(20),
                      [&] { return stopped_ || !waiting_.empty(); });
    if (waiting_.empty()) return stopped_ ? SourceStatus::kEnd : SourceStatus::kIdle;
    packet.bytes = std::move(waiting_.front());
    waiting_.pop_front();
    packet.port = 7502;
    packet.host_time.ns = kFakeStart_ns + packet_gap_ns_ * count_++;
    return SourceStatus::kPacket;
  }
  void stop() override {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

 private:
  const std::int64_t packet_gap_ns_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Bytes> waiting_;
  std::int64_t count_ = 0;
  bool stopped_ = false;
};

/// Everything of glintd but the process: a fake sensor, the threads, a server on a free port.
class TestDaemon {
 public:
  explicit TestDaemon(daemon::Config config = {}, daemon::RuntimeOptions options = {}) {
    config.server.listen = "127.0.0.1:0";
    // What a sensor sends in seconds comes at once.
    config.slam.load_level = "none";
    auto source = std::make_unique<FakeSource>(info_.scan_period_ns() * info_.columns_per_packet /
                                               info_.columns_per_frame);
    source_ = source.get();
    runtime_ = std::make_unique<daemon::Runtime>(info_, config, std::move(source), options);
    api_ = std::make_unique<daemon::Api>(io_, *runtime_, config);
    server_ = std::make_unique<daemon::Server>(io_, *api_, config);
    port_ = server_->tcp_port();
    runtime_->start([this](const auto& snapshot) { server_->publish(snapshot); });
    server_->start();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~TestDaemon() {
    boost::asio::post(io_, [this] {
      server_->close();
      io_.stop();
    });
    thread_.join();
    runtime_->stop();
  }
  TestDaemon(const TestDaemon&) = delete;
  TestDaemon& operator=(const TestDaemon&) = delete;

  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] const SensorInfo& info() const { return info_; }
  daemon::Runtime& runtime() { return *runtime_; }
  /// As after SIGHUP. @throws what the server does.
  void read_secrets_again(const daemon::Config& config) {
    std::packaged_task<void()> task([&] { server_->read_secrets_again(config.server); });
    std::future<void> done = task.get_future();
    boost::asio::post(io_, [&task] { task(); });
    done.get();
  }
  FakeSource& source() { return *source_; }
  void feed(const std::vector<Bytes>& packets) {
    for (const Bytes& packet : packets) source_->feed(packet);
  }

  /// Polls get_pose/get_status until `done(result)`; false after ten seconds.
  template <class Done>
  bool wait_for(const char* method, Done done) {
    daemon::Client client(address());
    for (int i = 0; i < 1000; ++i) {
      if (done(client.call(method))) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

 private:
  const SensorInfo info_ = room_sensor();
  boost::asio::io_context io_{1};
  FakeSource* source_ = nullptr;
  std::unique_ptr<daemon::Runtime> runtime_;
  std::unique_ptr<daemon::Api> api_;
  std::unique_ptr<daemon::Server> server_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// Whether get_status says that `count` poses were published.
inline bool has_poses(const daemon::Json& status, int count) {
  return status["counters"]["poses"] == count;
}

}  // namespace glint::test
