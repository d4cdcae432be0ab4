// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "pcap/byte_order.hpp"
#include "pcap/endpoint.hpp"

namespace glint::test {

using Buffer = std::vector<std::uint8_t>;

/// Link types as numbered in capture files.
constexpr std::uint32_t kLinkNull = 0;
constexpr std::uint32_t kLinkEthernet = 1;
constexpr std::uint32_t kLinkRaw = 101;
constexpr std::uint32_t kLinkWifi = 105;
constexpr std::uint32_t kLinkLoop = 108;
constexpr std::uint32_t kLinkCooked = 113;
constexpr std::uint32_t kLinkIpv4 = 228;
constexpr std::uint32_t kLinkIpv6 = 229;
constexpr std::uint32_t kLinkCooked2 = 276;

/// A folder that goes away with its object.
class TempDir {
 public:
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// Joins pieces of a packet.
Buffer join(std::initializer_list<Buffer> pieces);
/// `size` bytes that differ from place to place and seed to seed.
Buffer pattern(std::size_t size, unsigned seed);

/// 192.0.2.1:1111 to 192.0.2.2:7502, and the same for IPv6: what the builders below write.
Endpoint sender(bool is_v6 = false);
Endpoint receiver(bool is_v6 = false);

/// A UDP datagram from sender() to receiver(), checksum right.
Buffer udp(const Buffer& payload, bool is_v6 = false);
/// An IPv4 packet around `payload`, as one fragment of datagram `id` at `offset` if asked.
Buffer ipv4(const Buffer& payload, std::uint16_t id = 0, std::size_t offset = 0, bool more = false,
            std::uint8_t protocol = 17);
/// An IPv6 packet; `next_header` is the type of what `payload` begins with.
Buffer ipv6(const Buffer& payload, std::uint8_t next_header = 17);
/// An IPv6 packet with a fragment header.
Buffer ipv6_fragment(const Buffer& payload, std::uint32_t id, std::size_t offset, bool more);
Buffer ethernet(const Buffer& payload, std::uint16_t ether_type = 0x0800);

/// A pcap file in memory.
class PcapBytes {
 public:
  explicit PcapBytes(std::uint32_t link_type, bool nanoseconds = true,
                     std::uint32_t snap_length = 262144);
  /// Appends a record; `original_size` above 0 says that it was cut when captured.
  void record(std::int64_t time_ns, const Buffer& bytes, std::size_t original_size = 0);
  Buffer& bytes() { return bytes_; }
  void save(const std::filesystem::path& file) const;

 private:
  bool nanoseconds_;
  Buffer bytes_;
};

/// A pcapng file of one Ethernet interface with nanosecond times, a record per packet, 1 ms apart.
Buffer pcapng(const std::vector<Buffer>& packets);
void save(const std::filesystem::path& file, const Buffer& bytes);

}  // namespace glint::test
