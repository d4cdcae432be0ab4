// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/emulate/packet_sender.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <utility>

#include "daemon/steady_clock.hpp"
#include "driver/core/error.hpp"

namespace glint::daemon {
namespace {

// What a packet on the line is, in place of its port: both kinds may go to one port.
constexpr std::uint16_t kLidar = 0;
constexpr std::uint16_t kImu = 1;
// Between two lidar packets, so that they do not fill the receiver's buffer.
constexpr int kForeignAtOnce = 8;
// Any address of the loopback network but the sensor's own.
constexpr const char* kStranger = "127.0.0.77";
constexpr const char* kOtherStranger = "127.0.0.78";

std::chrono::steady_clock::time_point at(std::int64_t steady_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(steady_ns));
}

}  // namespace

PacketSender::PacketSender(emulator::PacketFeed& feed, const emulator::PacketRestamper& restamper,
                           PacketSenderOptions options,
                           std::function<void(const std::string&)> on_end)
    : feed_(feed),
      restamper_(restamper),
      options_(std::move(options)),
      on_end_(std::move(on_end)),
      silent_since_ns_(steady_now_ns()),
      network_({}, options_.seed) {
  network_.set_observer([this](const RawPacket& packet, synth::DatagramFate fate) {
    const std::lock_guard lock(mutex_);
    count_fate(packet, fate);
  });
  thread_ = std::thread([this] { run(); });
}

PacketSender::~PacketSender() { stop(); }

void PacketSender::set_stream(const emulator::EmulatedStream& stream) {
  const std::lock_guard lock(mutex_);
  wanted_.stream = stream;
  changed_.notify_all();
}

void PacketSender::set_faults(const emulator::PacketFaults& faults) {
  const std::lock_guard lock(mutex_);
  wanted_.faults = faults;
}

void PacketSender::send_foreign(std::uint64_t count) {
  const std::lock_guard lock(mutex_);
  wanted_.foreign += count;
}

void PacketSender::stop() {
  {
    const std::lock_guard lock(mutex_);
    wanted_.stop = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

EmulationCounts PacketSender::counts() const {
  const std::lock_guard lock(mutex_);
  EmulationCounts counts = counts_;
  if (!stream_.sending) counts.not_sent += silent_packets();
  return counts;
}

void PacketSender::run() {
  std::string error;
  try {
    send_all();
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  on_end_(error);
}

void PacketSender::send_all() {
  const auto pull_next = [this](RawPacket& packet) {
    std::unique_lock lock(mutex_);
    return pull(packet, lock);
  };
  RawPacket packet;
  while (true) {
    if (network_.receive(pull_next, packet) == SourceStatus::kPacket) {
      deliver(packet);
      continue;
    }
    std::unique_lock lock(mutex_);
    if (feed_ended_) return;
    changed_.wait(lock, [this] { return wanted_.stop || wanted_.stream.sending; });
    if (wanted_.stop) return;
  }
}

/// The sensor's next packet when it is due; kEnd when it stops or pauses.
SourceStatus PacketSender::pull(RawPacket& packet, std::unique_lock<std::mutex>& lock) {
  while (follow()) {
    if (!has_next_) has_next_ = feed_.next(next_);
    if (!has_next_) {
      feed_ended_ = true;
      end_stream();
      break;
    }
    if (options_.rate && steady_now_ns() < due_ns()) {
      changed_.wait_until(lock, at(due_ns()));
    } else if (take_next(packet)) {
      return SourceStatus::kPacket;
    }
  }
  return SourceStatus::kEnd;
}

/// Does what has been asked for since. False when nothing is sent now.
bool PacketSender::follow() {
  const emulator::EmulatedStream& wanted = wanted_.stream;
  const bool same = wanted.sending && wanted.init_id == stream_.init_id && !wanted_.stop;
  if (stream_.sending && !same) {
    end_stream();  // What is on the way arrives first, then another may begin.
    return false;
  }
  if (!wanted.sending || wanted_.stop) return false;
  if (!stream_.sending) {
    start_stream();
  } else if (wanted != stream_) {
    adapt_stream();
  }
  const emulator::PacketFaults& faults = wanted_.faults;
  network_.set_faults({faults.loss, faults.duplicates, faults.reordering, faults.delay_ns});
  return true;
}

void PacketSender::start_stream() {
  counts_.not_sent += silent_packets();
  ++counts_.starts;
  stream_ = wanted_.stream;
  began_ns_ = steady_now_ns();
  first_offset_ns_ = stream_.clock_offset_ns;
  feed_.begin(stream_.init_id, {stream_.sensor_time_ns(began_ns_)});
  open_sockets();
}

void PacketSender::end_stream() {
  if (sent_of_scan_ > 0) counts_.cut_packets += feed_.packets_per_scan() - sent_of_scan_;
  sent_of_scan_ = 0;
  has_next_ = false;
  silent_since_ns_ = steady_now_ns();
  stream_.sending = false;
}

void PacketSender::adapt_stream() {
  const emulator::EmulatedStream before = std::exchange(stream_, wanted_.stream);
  if (before.clock_offset_ns != stream_.clock_offset_ns) {
    ++counts_.clock_jumps;
    feed_.set_clock_offset(stream_.clock_offset_ns - first_offset_ns_);
  }
  const bool elsewhere = before.destination != stream_.destination ||
                         before.lidar_port != stream_.lidar_port ||
                         before.imu_port != stream_.imu_port;
  if (elsewhere) open_sockets();
}

void PacketSender::open_sockets() {
  const auto port = [](int number) { return static_cast<std::uint16_t>(number); };
  lidar_.reset();
  imu_.reset();
  stranger_.reset();
  try {
    lidar_.emplace(stream_.destination, port(stream_.lidar_port), options_.from);
    imu_.emplace(stream_.destination, port(stream_.imu_port), options_.from);
  } catch (const InputError& error) {
    std::cerr << "glint: the emulated sensor cannot send: " << error.what() << '\n';
    return;
  }
  if (!stream_.destination.starts_with("127.")) return;
  stranger_.emplace(stream_.destination, port(stream_.lidar_port),
                    options_.from == kStranger ? kOtherStranger : kStranger);
}

/// Hands out the packet that is due; false when the sensor sends none of its kind.
bool PacketSender::take_next(RawPacket& packet) {
  has_next_ = false;
  const std::int64_t due = due_ns();
  if ((next_.is_imu ? stream_.imu_port : stream_.lidar_port) == 0) {
    if (!next_.is_imu) ++counts_.not_sent;
    return false;
  }
  if (!next_.is_imu) {
    ++sent_of_scan_;
    if (next_.ends_scan) {
      ++counts_.scans;
      sent_of_scan_ = 0;
    }
  }
  std::swap(packet.bytes, next_.packet.bytes);
  packet.port = next_.is_imu ? kImu : kLidar;
  packet.host_time = {options_.rate ? due : steady_now_ns()};
  return true;
}

void PacketSender::count_fate(const RawPacket& packet, synth::DatagramFate fate) {
  PacketCounts& counts = packet.port == kImu ? counts_.imu : counts_.lidar;
  ++counts.sent;
  if (fate == synth::DatagramFate::kLost) ++counts.lost;
  if (fate == synth::DatagramFate::kDelayed) ++counts.delayed;
  if (fate == synth::DatagramFate::kDuplicated) ++counts.duplicated;
}

std::int64_t PacketSender::due_ns() const {
  const double since_begin_ns =
      static_cast<double>(next_.packet.host_time.ns) / options_.rate.value_or(1.0);
  return began_ns_ + std::llround(since_begin_ns);
}

/// Lidar packets that a sensor would have sent since this one fell silent; none before it began.
std::uint64_t PacketSender::silent_packets() const {
  if (counts_.starts == 0) return 0;
  const double silent_s = static_cast<double>(steady_now_ns() - silent_since_ns_) * kSecondsPerNs;
  const double packets_per_s = feed_.lidar_packets_per_s() * options_.rate.value_or(1.0);
  return static_cast<std::uint64_t>(std::llround(std::max(silent_s, 0.0) * packets_per_s));
}

void PacketSender::deliver(const RawPacket& packet) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, at(packet.host_time.ns), [this] { return wanted_.stop; });
  const std::int64_t late_ns = steady_now_ns() - packet.host_time.ns;
  lock.unlock();
  const std::optional<UdpSender>& line = packet.port == kImu ? imu_ : lidar_;
  const bool sent = line && line->try_send(packet.bytes);
  lock.lock();
  PacketCounts& counts = packet.port == kImu ? counts_.imu : counts_.lidar;
  ++(sent ? counts.delivered : counts.failed);
  counts_.worst_lateness_ns = std::max(counts_.worst_lateness_ns, late_ns);
  const std::uint64_t foreign = std::min<std::uint64_t>(wanted_.foreign, kForeignAtOnce);
  if (packet.port == kImu || foreign == 0 || !lidar_) return;
  wanted_.foreign -= foreign;
  for (std::uint64_t i = 0; i < foreign; ++i) deliver_foreign(packet.bytes);
}

/// By turns from another address, a byte short, and of another serial number.
void PacketSender::deliver_foreign(const std::vector<std::byte>& lidar_packet) {
  foreign_ = lidar_packet;
  const std::uint64_t turn = foreign_sent_++ % 3;
  if (turn == 0 && stranger_) {
    if (stranger_->try_send(foreign_)) ++counts_.foreign_address;
  } else if (turn == 1 && restamper_.change_serial_number(foreign_)) {
    if (lidar_->try_send(foreign_)) ++counts_.foreign_serial;
  } else {
    foreign_.pop_back();
    if (lidar_->try_send(foreign_)) ++counts_.foreign_size;
  }
}

}  // namespace glint::daemon
