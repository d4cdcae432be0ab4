// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/record/packet_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "daemon/steady_clock.hpp"
#include "driver/core/packet_view.hpp"

namespace glint::daemon {
namespace {

// Received and not yet written: over three seconds of the fastest sensor, for a disk that is busy.
constexpr std::size_t kQueueBytes = std::size_t{128} << 20U;
constexpr std::int64_t kFlushPeriod_ns = kNsPerSecond / 4;
constexpr std::int64_t kSyncPeriod_ns = kNsPerSecond;

}  // namespace

PacketRecorder::PacketRecorder(const Line& line, const SensorInfo& info, CaptureParts& parts,
                               std::function<void(const std::string&)> on_error)
    : line_(line),
      format_(info),
      parts_(parts),
      on_error_(std::move(on_error)),
      source_(line.udp),
      queue_(kQueueBytes / format_.packet_bytes) {
  receiver_ = std::thread([this] { receive(); });
  writer_ = std::thread([this] { write(); });
}

PacketRecorder::~PacketRecorder() { stop(); }

void PacketRecorder::stop() {
  source_.stop();
  if (receiver_.joinable()) receiver_.join();
  queue_.close();
  if (writer_.joinable()) writer_.join();
}

void PacketRecorder::set_metadata(std::string metadata_json) {
  const std::lock_guard lock(mutex_);
  next_metadata_ = std::move(metadata_json);
}

ReceivedCounts PacketRecorder::counts() const { return {lidar_, imu_, other_}; }

PacketActivity PacketRecorder::activity() const { return {last_packet_ns_, init_id_}; }

void PacketRecorder::receive() {
  RawPacket packet;
  while (true) {
    const SourceStatus status = source_.read(packet);
    if (status == SourceStatus::kPacket) take(packet);
    if (status == SourceStatus::kError) fail(source_.error());
    if (status == SourceStatus::kError || status == SourceStatus::kEnd) return;
  }
}

void PacketRecorder::take(RawPacket& packet) {
  last_packet_ns_ = steady_now_ns();
  if (packet.bytes.size() == format_.packet_bytes) {
    ++lidar_;
    if (const auto view = PacketView::parse(format_, packet.bytes)) init_id_ = view->init_id();
  } else if (packet.bytes.size() == format_.imu_packet_bytes) {
    ++imu_;
  } else {
    ++other_;
  }
  queue_.push_drop_oldest(packet);
}

void PacketRecorder::write() {
  try {
    write_all();
  } catch (const std::exception& error) {
    queue_.close();
    fail(error.what());
  }
}

void PacketRecorder::write_all() {
  using Result = BoundedQueue<RawPacket>::PopResult;
  RawPacket packet;
  std::int64_t flushed_ns = steady_now_ns();
  std::int64_t synced_ns = flushed_ns;
  while (true) {
    const Result result = queue_.pop(packet, std::chrono::milliseconds(100));
    if (result == Result::kClosed) break;
    if (result == Result::kItem) {
      parts_.write(packet.host_time, {line_.sensor, packet.port}, {line_.host, packet.port},
                   packet.bytes);
    }
    const std::int64_t now_ns = steady_now_ns();
    if (now_ns - synced_ns >= kSyncPeriod_ns) {
      parts_.sync();
      flushed_ns = synced_ns = steady_now_ns();
    } else if (now_ns - flushed_ns >= kFlushPeriod_ns) {
      parts_.flush();
      flushed_ns = now_ns;
    }
    std::string metadata;
    {
      const std::lock_guard lock(mutex_);
      metadata = std::exchange(next_metadata_, {});
    }
    if (!metadata.empty()) parts_.set_metadata(std::move(metadata));
  }
  parts_.finish();
}

void PacketRecorder::fail(const std::string& sentence) {
  if (!failed_.exchange(true)) on_error_(sentence);
}

}  // namespace glint::daemon
