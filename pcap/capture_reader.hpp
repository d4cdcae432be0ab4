// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "driver/core/time.hpp"
#include "pcap/endpoint.hpp"
#include "pcap/ip_reassembler.hpp"

namespace glint {

/// A whole UDP datagram of a capture. Non-owning: valid until the reader's next call.
struct Datagram {
  HostTime host_time;  ///< Of its record; of the last fragment's when it came in fragments.
  Endpoint source;
  Endpoint destination;
  std::span<const std::byte> payload;
};

/// What became of every record read: each is in exactly one of the counters below `records`, and
/// the fragments are accounted for in `reassembly`.
struct CaptureCounters {
  std::uint64_t records = 0;
  std::uint64_t whole_datagrams = 0;    ///< UDP, unfragmented.
  std::uint64_t fragments = 0;          ///< Of UDP datagrams.
  std::uint64_t other_protocols = 0;    ///< Not IP, or not UDP.
  std::uint64_t truncated_records = 0;  ///< Cut by the capture's snap length.
  std::uint64_t malformed_records = 0;  ///< Headers that contradict themselves.
  ReassemblyCounters reassembly;
};

/// Reads the UDP datagrams of a pcap or pcapng file, in file order. Link types: Ethernet (with any
/// stack of VLAN tags), Linux cooked v1 and v2, raw IP, loopback. IP fragments are put together.
/// A file that breaks off is used as far as it goes; problem() then says so. Thread-compatible.
class CaptureReader {
 public:
  /// @throws InputError if the file is missing, no capture, or of an unknown link type.
  explicit CaptureReader(std::filesystem::path file);
  ~CaptureReader();
  CaptureReader(const CaptureReader&) = delete;
  CaptureReader& operator=(const CaptureReader&) = delete;

  /// The next datagram; null at the end.
  const Datagram* next();

  [[nodiscard]] CaptureCounters counters() const;
  /// The capture's link type as libpcap names it, e.g. "EN10MB".
  [[nodiscard]] const std::string& link_type() const;
  /// A sentence on where and why reading stopped before the file's end; empty if it did not.
  [[nodiscard]] const std::string& problem() const;
  [[nodiscard]] const std::filesystem::path& file() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint
