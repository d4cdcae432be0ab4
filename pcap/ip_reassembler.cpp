// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/ip_reassembler.hpp"

#include <algorithm>

#include "pcap/internet_checksum.hpp"

namespace glint {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65535;
/// Fragments looked at per attempt to tile a datagram; bounds the work hostile captures can cause.
/// Without strays an attempt needs as many as the datagram has fragments.
constexpr std::size_t kMaxTries = 2048;

bool well_formed(const IpPacket& packet) {
  if (packet.payload.empty()) return false;
  if (packet.fragment_offset + packet.payload.size() > kMaxDatagramBytes) return false;
  return !packet.more_fragments || packet.payload.size() % 8 == 0;
}

bool checksum_right(const IpAddress& source, const IpAddress& destination, Bytes udp) {
  if (udp.size() < kUdpHeaderBytes) return false;
  const bool has_checksum = load_be16(udp, 6) != 0;
  return !has_checksum || udp_checksum(source, destination, udp) == 0;
}

}  // namespace

Bytes IpReassembler::push(const IpPacket& packet, HostTime time) {
  expire(time);
  if (!well_formed(packet)) {
    ++counters_.malformed_fragments;
    return {};
  }
  ++counters_.fragments;
  make_room(packet.payload.size());
  Partial& partial = find_or_begin(
      {packet.source, packet.destination, packet.protocol, packet.identification}, time);
  const auto same = [&](const Fragment& held) {
    return held.offset == packet.fragment_offset && held.more == packet.more_fragments &&
           std::ranges::equal(held.bytes, packet.payload);
  };
  if (std::ranges::any_of(partial.fragments, same)) {
    ++counters_.duplicate_fragments;
    return {};
  }
  if (partial.fragments.size() == limits_.max_fragments) {
    give_up(std::prev(partials_.end()), counters_.evicted);
    return {};
  }
  add(partial, packet);
  if (!assemble(partial)) return {};
  erase(std::prev(partials_.end()));
  ++counters_.datagrams;
  return datagram_;
}

void IpReassembler::finish() {
  while (!partials_.empty()) give_up(partials_.begin(), counters_.timed_out);
}

void IpReassembler::expire(HostTime now) {
  while (!partials_.empty() && now - partials_.front().last_time > limits_.timeout_ns) {
    give_up(partials_.begin(), counters_.timed_out);
  }
}

void IpReassembler::make_room(std::size_t bytes) {
  while (!partials_.empty() && bytes_held_ + bytes > limits_.max_bytes) {
    give_up(partials_.begin(), counters_.evicted);
  }
}

IpReassembler::Partial& IpReassembler::find_or_begin(const Key& key, HostTime time) {
  const auto found = index_.find(key);
  if (found != index_.end()) {
    partials_.splice(partials_.end(), partials_, found->second);
    found->second->last_time = time;
  } else {
    if (partials_.size() >= limits_.max_datagrams) give_up(partials_.begin(), counters_.evicted);
    partials_.push_back({key, time, {}});
    index_.emplace(key, std::prev(partials_.end()));
  }
  return partials_.back();
}

void IpReassembler::add(Partial& partial, const IpPacket& packet) {
  partial.fragments.push_back({packet.fragment_offset,
                               packet.more_fragments,
                               {packet.payload.begin(), packet.payload.end()}});
  partial.bytes += packet.payload.size();
  bytes_held_ += packet.payload.size();
  if (!packet.more_fragments) {
    partial.end = std::min(partial.end, packet.fragment_offset + packet.payload.size());
  }
}

bool IpReassembler::assemble(Partial& partial) {
  if (partial.bytes < partial.end) return false;
  datagram_.clear();
  Search search{kMaxTries};
  const bool done = extend(partial, search);
  if (done) counters_.stray_fragments += partial.fragments.size() - search.tiles;
  partial.checksum_failed = search.complete && !done;
  return done;
}

/// Depth-first search for a tiling, from the end of datagram_ onwards.
bool IpReassembler::extend(const Partial& partial, Search& search) {
  const std::size_t at = datagram_.size();
  for (auto f = partial.fragments.rbegin(); f != partial.fragments.rend(); ++f) {
    if (f->offset != at) continue;
    if (search.tries_left == 0) return false;
    --search.tries_left;
    ++search.tiles;
    datagram_.insert(datagram_.end(), f->bytes.begin(), f->bytes.end());
    if (f->more) {
      if (extend(partial, search)) return true;
    } else {
      search.complete = true;
      if (checksum_right(std::get<0>(partial.key), std::get<1>(partial.key), datagram_))
        return true;
    }
    --search.tiles;
    datagram_.resize(at);
  }
  return false;
}

void IpReassembler::give_up(Partials::iterator partial, std::uint64_t& counter) {
  ++(partial->checksum_failed ? counters_.bad_checksums : counter);
  erase(partial);
}

void IpReassembler::erase(Partials::iterator partial) {
  bytes_held_ -= partial->bytes;
  index_.erase(partial->key);
  partials_.erase(partial);
}

}  // namespace glint
