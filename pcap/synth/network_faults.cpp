// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/network_faults.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

constexpr int kMostBehind = 3;

void require_share(double share, const char* what) {
  if (share >= 0.0 && share < 1.0) return;
  throw OptionError(
      fmt::format("{} is a share of all datagrams, from 0 to below 1, not {}", what, share));
}

void check(const NetworkFaults& faults) {
  require_share(faults.loss, "loss");
  require_share(faults.duplicates, "duplicates");
  require_share(faults.reordering, "reordering");
  if (faults.delay_ns < 0) throw OptionError("delay is a time from 0 on");
}

}  // namespace

FaultyNetwork::FaultyNetwork(const NetworkFaults& faults, std::uint64_t seed)
    : random_{seed, 0x9E7F417ULL} {
  set_faults(faults);
}

void FaultyNetwork::set_faults(const NetworkFaults& faults) {
  check(faults);
  faults_ = faults;
}

SourceStatus FaultyNetwork::receive(const std::function<SourceStatus(RawPacket&)>& send,
                                    RawPacket& packet) {
  while (true) {
    if (arrive_late(packet, false)) return SourceStatus::kPacket;
    const SourceStatus status = send(packet);
    if (status == SourceStatus::kEnd && arrive_late(packet, true)) return SourceStatus::kPacket;
    if (status != SourceStatus::kPacket) return status;
    ++counts_.sent;
    const DatagramFate fate = draw_fate();
    if (observer_) observer_(packet, fate);
    if (fate == DatagramFate::kDelayed) hold(packet);
    if (fate == DatagramFate::kLost || fate == DatagramFate::kDelayed) continue;
    now_ = packet.host_time;
    pass_held();
    if (fate == DatagramFate::kDuplicated) hold(packet);
    packet.host_time = packet.host_time + faults_.delay_ns;
    return status;
  }
}

DatagramFate FaultyNetwork::draw_fate() {
  if (random_.chance(faults_.loss)) {
    ++counts_.lost;
    return DatagramFate::kLost;
  }
  if (random_.chance(faults_.reordering)) {
    ++counts_.delayed;
    return DatagramFate::kDelayed;
  }
  if (random_.chance(faults_.duplicates)) {
    ++counts_.duplicated;
    return DatagramFate::kDuplicated;
  }
  return DatagramFate::kArrives;
}

void FaultyNetwork::hold(const RawPacket& packet) {
  held_.push_back({packet, 1 + random_.below(kMostBehind)});
}

bool FaultyNetwork::arrive_late(RawPacket& packet, bool line_is_empty) {
  const auto due = std::find_if(held_.begin(), held_.end(), [&](const Held& held) {
    return held.behind <= 0 || line_is_empty;
  });
  if (due == held_.end()) return false;
  packet = std::move(due->packet);
  packet.host_time = std::max(packet.host_time, now_) + faults_.delay_ns;
  held_.erase(due);
  pass_held();
  return true;
}

// By late ones too, so that none is passed by more than kMostBehind.
void FaultyNetwork::pass_held() {
  for (Held& held : held_) --held.behind;
}

}  // namespace glint::synth
