// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <tuple>
#include <vector>

#include "driver/core/time.hpp"
#include "pcap/ip_packet.hpp"

namespace glint {

struct ReassemblyLimits {
  std::size_t max_datagrams = 256;  ///< Unfinished at a time; the longest untouched gives way.
  std::size_t max_bytes =
      16U << 20U;  ///< Held in unfinished datagrams; the longest untouched gives way.
  std::size_t max_fragments = 256;  ///< Of one datagram: 65,507 bytes at an MTU of 296.
  /// An unfinished datagram is given up when none of its fragments came for this long. They follow
  /// each other within milliseconds; an identification comes around again after some ten seconds.
  std::int64_t timeout_ns = kNsPerSecond;
};

/// What became of every fragment and every datagram begun.
struct ReassemblyCounters {
  std::uint64_t fragments = 0;            ///< Taken in.
  std::uint64_t malformed_fragments = 0;  ///< Empty, past 64 KiB, or inner ones of odd length.
  std::uint64_t duplicate_fragments = 0;  ///< Same place and same bytes as one already held.
  std::uint64_t stray_fragments = 0;  ///< Left over when their identification's datagram was done.
  std::uint64_t datagrams = 0;        ///< Put together.
  std::uint64_t bad_checksums = 0;    ///< Complete, but never with a right UDP checksum.
  std::uint64_t timed_out = 0;        ///< Incomplete for too long, or at the end of the capture.
  std::uint64_t evicted = 0;          ///< Gave way to newer ones at a limit.
};

/// Puts UDP datagrams together from IPv4 or IPv6 fragments, in any order.
///
/// Fragments of one datagram tile it without gap or overlap. A stray fragment that shares its
/// addresses and identification with a datagram therefore competes with the one it would displace:
/// both are kept, newer ones are tried first, and the UDP checksum (where there is one) decides.
/// Time is that of the packets. Thread-compatible.
class IpReassembler {
 public:
  explicit IpReassembler(ReassemblyLimits limits = {}) : limits_(limits) {}

  /// Takes one fragment (packet.is_fragment, UDP). Returns the UDP datagram, header included, that
  /// it completes, valid until the next call; empty if none.
  Bytes push(const IpPacket& packet, HostTime time);

  /// Gives up what is unfinished: the capture is over.
  void finish();

  [[nodiscard]] const ReassemblyCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t datagrams_in_flight() const { return partials_.size(); }
  [[nodiscard]] std::size_t bytes_in_flight() const { return bytes_held_; }

 private:
  using Key = std::tuple<IpAddress, IpAddress, std::uint8_t, std::uint32_t>;
  struct Fragment {
    std::uint32_t offset;
    bool more;
    std::vector<std::uint8_t> bytes;
  };
  struct Partial {
    Key key;
    HostTime last_time;               ///< Of its latest fragment.
    std::vector<Fragment> fragments;  ///< In order of arrival.
    std::size_t bytes = 0;            ///< Of all fragments.
    std::size_t end = SIZE_MAX;       ///< Where it ends by its last fragment (the nearest of them).
    bool checksum_failed = false;
  };
  using Partials = std::list<Partial>;
  struct Search {
    std::size_t tries_left;
    std::size_t tiles = 0;  ///< Fragments used.
    bool complete = false;  ///< Some tiling reached the end, whatever its checksum.
  };

  void expire(HostTime now);
  void make_room(std::size_t bytes);
  Partial& find_or_begin(const Key& key, HostTime time);
  void add(Partial& partial, const IpPacket& packet);
  bool assemble(Partial& partial);
  bool extend(const Partial& partial, Search& search);
  void give_up(Partials::iterator partial, std::uint64_t& counter);
  void erase(Partials::iterator partial);

  const ReassemblyLimits limits_;
  Partials partials_;  ///< Longest untouched first, newest last.
  std::map<Key, Partials::iterator> index_;
  std::size_t bytes_held_ = 0;
  std::vector<std::uint8_t> datagram_;
  ReassemblyCounters counters_;
};

}  // namespace glint
