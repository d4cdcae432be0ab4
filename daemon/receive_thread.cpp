// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/receive_thread.hpp"

#include <algorithm>

namespace glint::daemon {
namespace {

/// What was not yet said before.
std::vector<std::string> later_notices(const PacketSource& source,
                                       const std::vector<std::string>& before) {
  std::vector<std::string> all = source.notices();
  std::erase_if(all, [&](const std::string& notice) {
    return std::ranges::find(before, notice) != before.end();
  });
  return all;
}

}  // namespace

void ReceiveThread::run() {
  SourceHealth& health = crossings_.source;
  const std::vector<std::string> notices_before = source_.notices();
  SourceStatus status = SourceStatus::kIdle;
  while (status != SourceStatus::kEnd && status != SourceStatus::kError) {
    heartbeat_.beat();
    status = source_.read(received_.packet);
    now_ns_ = steady_now_ns();
    if (status == SourceStatus::kPacket) take_packet();
    tell_silence();
    health.kernel_drops.store(source_.kernel_drops(), std::memory_order_relaxed);
    health.foreign.store(source_.foreign(), std::memory_order_relaxed);
  }
  health.notices = later_notices(source_, notices_before);
  if (status == SourceStatus::kError) health.error = source_.error();
  health.state = status == SourceStatus::kError ? SourceState::kFailed : SourceState::kEnded;
  crossings_.packets.close();
  heartbeat_.finish();
}

void ReceiveThread::take_packet() {
  SourceHealth& health = crossings_.source;
  received_.arrival_ns = now_ns_;
  received_.silence = false;
  health.packets.fetch_add(1, std::memory_order_relaxed);
  if (is_sign_of_life()) {
    health.last_packet_ns.store(now_ns_, std::memory_order_relaxed);
    health.state.store(SourceState::kRunning, std::memory_order_relaxed);
  }
  if (lossless_) {
    crossings_.packets.push_wait(received_);
  } else {
    crossings_.packets.push_drop_oldest(received_);
  }
}

bool ReceiveThread::is_sign_of_life() const {
  const std::size_t expected = crossings_.expected.lidar_bytes.load(std::memory_order_relaxed);
  return expected == 0 || received_.packet.bytes.size() == expected;
}

void ReceiveThread::tell_silence() {
  // Only the reader of the socket can tell silence from a machine that is busy: to it, packets that
  // wait in the kernel's buffer are no silence. A capture is never silent, it ends.
  SourceHealth& health = crossings_.source;
  const bool running = health.state.load(std::memory_order_relaxed) == SourceState::kRunning;
  if (lossless_ || !running) return;
  const std::int64_t silence_ns = crossings_.expected.silence_ns.load(std::memory_order_relaxed);
  if (now_ns_ - health.last_packet_ns.load(std::memory_order_relaxed) < silence_ns) return;
  health.state = SourceState::kStalled;
  received_.silence = true;
  crossings_.packets.push_drop_oldest(received_);
}

}  // namespace glint::daemon
