// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>

#include "driver/core/bytes.hpp"
#include "driver/core/profile_table.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::bench {

/// Longer than the caches, so that packets come from memory as they do from the kernel.
constexpr std::size_t kStreamingBytes = 64U << 20U;
/// A few scans, which stay in the cache.
constexpr std::size_t kHotBytes = 3U << 20U;

/// A run of scans' packets in one block of memory, random in every field, played again and again
/// with ever newer ids.
class PacketRing {
 public:
  PacketRing(const SensorInfo& info, std::size_t bytes) : format_(info) {
    std::mt19937 random(1);
    const auto packets = test::encode(info, test::random_scan(info, 0, random));
    packets_per_scan_ = packets.size();
    while (bytes_.size() < bytes) {
      for (const test::Bytes& packet : packets) {
        bytes_.insert(bytes_.end(), packet.begin(), packet.end());
      }
      ++scans_;
    }
    renumber();
  }

  [[nodiscard]] std::size_t size() const { return scans_ * packets_per_scan_; }
  [[nodiscard]] std::size_t scans() const { return size() / packets_per_scan_; }
  [[nodiscard]] std::size_t packets_per_scan() const { return packets_per_scan_; }
  [[nodiscard]] const PacketFormat& format() const { return format_; }
  [[nodiscard]] std::span<const std::byte> packet(std::size_t index) const {
    return {bytes_.data() + index * format_.packet_bytes, format_.packet_bytes};
  }

  /// Gives the scans the frame ids and times after those they had.
  void renumber() {
    for (std::size_t i = 0; i < size(); ++i) {
      const std::uint64_t scan = first_scan_ + i / packets_per_scan_;
      std::byte* packet = bytes_.data() + i * format_.packet_bytes;
      const auto frame_id = static_cast<std::uint16_t>(scan);
      if (!format_.legacy()) store(packet + kStandardHeader.frame_id_offset, frame_id);
      for (int c = 0; c < format_.columns_per_packet; ++c) {
        std::byte* column = packet + format_.layout->packet_header_bytes +
                            static_cast<std::size_t>(c) * format_.column_bytes;
        store(column + kColumnTimeOffset, std::uint64_t{1'000'000'000} + scan * 100'000'000U);
        if (format_.legacy()) store(column + kLegacyFrameIdOffset, frame_id);
      }
    }
    first_scan_ += scans_;
  }

  /// Copies every packet to its place in a buffer of a scan's size: what all is measured against.
  void copy_to(test::Bytes& scan) const {
    scan.resize(packets_per_scan_ * format_.packet_bytes);
    for (std::size_t i = 0; i < size(); ++i) {
      std::memcpy(scan.data() + i % packets_per_scan_ * format_.packet_bytes, packet(i).data(),
                  format_.packet_bytes);
      asm volatile("" ::: "memory");  // each copy is made
    }
  }

 private:
  PacketFormat format_;
  test::Bytes bytes_;
  std::size_t packets_per_scan_ = 0;
  std::uint64_t scans_ = 0;
  std::uint64_t first_scan_ = 0;
};

}  // namespace glint::bench
