// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <vector>

#include "driver/core/time.hpp"
#include "pcap/endpoint.hpp"

namespace glint {

struct CaptureWriterOptions {
  /// Largest IP packet, bytes: larger datagrams are written as real IP fragments.
  /// 0: each datagram is one record, whatever its size, as captures off an offloading card are.
  int mtu = 0;
  /// The file has its name from the start and stays when the writer goes away: for recordings that
  /// must survive whatever ends them.
  bool in_place = false;
};

/// Writes UDP datagrams to a capture: nanosecond pcap, Ethernet, IPv4 or IPv6, correct checksums.
/// Unless it is written in place, the file has its final name only after finish(); until then it is
/// FILE.part, which is removed if the writer goes away unfinished, so that no half capture looks
/// whole. Thread-compatible.
class CaptureWriter {
 public:
  /// Largest UDP payload over IPv4, bytes.
  static constexpr std::size_t kMaxPayloadBytes = 65507;

  /// @throws InputError if the file cannot be created, or the MTU is below 576 (IPv4's minimum).
  explicit CaptureWriter(std::filesystem::path file, CaptureWriterOptions options = {});
  ~CaptureWriter();
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;

  /// Appends one datagram. Both endpoints must be of one address family.
  /// @throws InputError on a failed write (disk full), or a datagram that UDP cannot carry.
  void write(HostTime host_time, const Endpoint& source, const Endpoint& destination,
             std::span<const std::byte> payload);

  /// Hands everything to the kernel: from then on it survives the end of this process.
  /// @throws InputError if that fails.
  void flush();
  /// Has it on the disk: from then on it survives a loss of power. May take as long as the disk
  /// does. @throws InputError if that fails.
  void sync();
  /// Writes everything out and gives the file its name. @throws InputError if that fails.
  void finish();

  /// Datagrams written so far.
  [[nodiscard]] std::uint64_t datagrams() const { return datagrams_; }
  /// Of the file so far.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  void write_packet(HostTime host_time, const Endpoint& source, const Endpoint& destination,
                    std::span<const std::uint8_t> ip_payload, std::size_t fragment_offset,
                    bool more_fragments);
  void put(std::span<const std::uint8_t> bytes);
  void remove_part() const;
  [[noreturn]] void fail(const char* action) const;

  const std::filesystem::path file_;
  const std::filesystem::path part_file_;  ///< What is written to; file_ itself when in place.
  const CaptureWriterOptions options_;
  std::FILE* stream_ = nullptr;
  std::uint64_t datagrams_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint16_t identification_ = 0;
  std::vector<std::uint8_t> udp_;     ///< UDP header and payload; reused.
  std::vector<std::uint8_t> record_;  ///< Record header and Ethernet frame; reused.
};

}  // namespace glint
