// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/receive_thread.hpp"

namespace glint::daemon {

void ReceiveThread::run() {
  SourceHealth& health = crossings_.source;
  SourceStatus status = SourceStatus::kIdle;
  while (status != SourceStatus::kEnd && status != SourceStatus::kError) {
    heartbeat_.beat();
    status = source_.read(received_.packet);
    if (status == SourceStatus::kPacket) take_packet();
    if (status == SourceStatus::kIdle) tell_silence();
    health.kernel_drops.store(source_.kernel_drops(), std::memory_order_relaxed);
    health.foreign.store(source_.foreign(), std::memory_order_relaxed);
  }
  if (status == SourceStatus::kError) health.error = source_.error();
  health.state = status == SourceStatus::kError ? SourceState::kFailed : SourceState::kEnded;
  crossings_.packets.close();
  heartbeat_.finish();
}

void ReceiveThread::take_packet() {
  SourceHealth& health = crossings_.source;
  last_packet_ns_ = steady_now_ns();
  received_.arrival_ns = last_packet_ns_;
  received_.silence = false;
  health.packets.fetch_add(1, std::memory_order_relaxed);
  health.state.store(SourceState::kRunning, std::memory_order_relaxed);
  if (options_.lossless) {
    crossings_.packets.push_wait(received_);
  } else {
    crossings_.packets.push_drop_oldest(received_);
  }
}

void ReceiveThread::tell_silence() {
  // Only the reader of the socket can tell silence from a machine that is busy: to it, packets that
  // wait in the kernel's buffer are no silence. A capture is never silent, it ends.
  const bool running = crossings_.source.state.load() == SourceState::kRunning;
  if (options_.lossless || !running) return;
  if (steady_now_ns() - last_packet_ns_ < options_.silence_ns) return;
  crossings_.source.state = SourceState::kStalled;
  received_.silence = true;
  crossings_.packets.push_drop_oldest(received_);
}

}  // namespace glint::daemon
