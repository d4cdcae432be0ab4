// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/capture_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "driver/core/error.hpp"
#include "pcap/internet_checksum.hpp"
#include "pcap/ip_packet.hpp"

namespace glint {
namespace {

constexpr int kMinMtu = 576;
constexpr std::uint8_t kNextHeaderFragment = 44;
constexpr std::uint8_t kHopLimit = 64;

/// Appends integers to a byte buffer: file fields little-endian, network fields big-endian.
class Appender {
 public:
  explicit Appender(std::vector<std::uint8_t>& out) : out_(out) {}
  void u8(unsigned value) { out_.push_back(static_cast<std::uint8_t>(value)); }
  void be16(std::size_t value) {
    u8((value >> 8) & 0xFF);
    u8(value & 0xFF);
  }
  void be32(std::uint32_t value) {
    be16(value >> 16);
    be16(value & 0xFFFF);
  }
  void le16(unsigned value) {
    u8(value & 0xFF);
    u8((value >> 8) & 0xFF);
  }
  void le32(std::uint32_t value) {
    le16(value & 0xFFFF);
    le16(value >> 16);
  }
  void bytes(Bytes data) { out_.insert(out_.end(), data.begin(), data.end()); }

 private:
  std::vector<std::uint8_t>& out_;
};

Bytes address_bytes(const IpAddress& address) {
  return {address.bytes.data(), address.is_v6 ? std::size_t{16} : std::size_t{4}};
}

void set_be16(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint16_t value) {
  bytes[at] = static_cast<std::uint8_t>(value >> 8);
  bytes[at + 1] = static_cast<std::uint8_t>(value & 0xFF);
}

void build_udp(const Endpoint& source, const Endpoint& destination,
               std::span<const std::byte> payload, std::vector<std::uint8_t>& udp) {
  udp.clear();
  Appender out(udp);
  const std::size_t length = kUdpHeaderBytes + payload.size();
  out.be16(source.port);
  out.be16(destination.port);
  out.be16(length);
  out.be16(0);
  udp.resize(length);
  if (!payload.empty()) std::memcpy(&udp[kUdpHeaderBytes], payload.data(), payload.size());
  const std::uint16_t sum = udp_checksum(source.address, destination.address, udp);
  // A computed 0 is sent as all ones; 0 would mean that there is no checksum (RFC 768).
  set_be16(udp, 6, sum == 0 ? 0xFFFF : sum);
}

void append_ethernet(Appender& out, bool is_v6) {
  // Locally administered addresses: no maker's card is imitated.
  out.bytes(std::array<std::uint8_t, 6>{0x02, 0, 0, 0, 0, 0x02});
  out.bytes(std::array<std::uint8_t, 6>{0x02, 0, 0, 0, 0, 0x01});
  out.be16(is_v6 ? 0x86DD : 0x0800);
}

void append_ipv4_header(std::vector<std::uint8_t>& record, const Endpoint& source,
                        const Endpoint& destination, std::size_t payload_bytes,
                        std::uint16_t identification, std::size_t fragment_offset,
                        bool more_fragments) {
  constexpr std::size_t kHeaderBytes = 20;
  const std::size_t start = record.size();
  Appender out(record);
  out.u8(0x45);
  out.u8(0);
  out.be16(kHeaderBytes + payload_bytes);
  out.be16(identification);
  out.be16((more_fragments ? 0x2000U : 0U) | (fragment_offset / 8));
  out.u8(kHopLimit);
  out.u8(kProtocolUdp);
  out.be16(0);
  out.bytes(address_bytes(source.address));
  out.bytes(address_bytes(destination.address));
  set_be16(record, start + 10, internet_checksum({&record[start], kHeaderBytes}));
}

void append_ipv6_header(std::vector<std::uint8_t>& record, const Endpoint& source,
                        const Endpoint& destination, std::size_t payload_bytes,
                        std::uint16_t identification, std::size_t fragment_offset,
                        bool more_fragments) {
  const bool fragment = fragment_offset != 0 || more_fragments;
  Appender out(record);
  out.be32(0x60000000);
  out.be16(payload_bytes + (fragment ? 8 : 0));
  out.u8(fragment ? kNextHeaderFragment : kProtocolUdp);
  out.u8(kHopLimit);
  out.bytes(address_bytes(source.address));
  out.bytes(address_bytes(destination.address));
  if (!fragment) return;
  out.u8(kProtocolUdp);
  out.u8(0);
  out.be16(fragment_offset | (more_fragments ? 1U : 0U));
  out.be32(identification);
}

}  // namespace

CaptureWriter::CaptureWriter(std::filesystem::path file, CaptureWriterOptions options)
    : file_(std::move(file)),
      part_file_(options.in_place ? file_.string() : file_.string() + ".part"),
      options_(options) {
  if (options_.mtu != 0 && options_.mtu < kMinMtu) {
    throw InputError(
        fmt::format("An MTU of {} bytes is below the {} that IP asks for; use 0 for "
                    "whole datagrams or e.g. 1500.",
                    options_.mtu, kMinMtu));
  }
  stream_ = std::fopen(part_file_.c_str(), "wb");
  if (stream_ == nullptr) fail("be created");
  std::vector<std::uint8_t> header;
  Appender out(header);
  out.le32(0xA1B23C4D);  // Nanosecond pcap.
  out.le16(2);
  out.le16(4);
  out.le32(0);
  out.le32(0);
  out.le32(262144);  // The snap length that tcpdump writes for "everything".
  out.le32(1);       // LINKTYPE_ETHERNET
  put(header);
}

CaptureWriter::~CaptureWriter() {
  if (stream_ == nullptr) return;
  std::fclose(stream_);
  remove_part();
}

void CaptureWriter::write(HostTime host_time, const Endpoint& source, const Endpoint& destination,
                          std::span<const std::byte> payload) {
  if (payload.size() > kMaxPayloadBytes) {
    throw InputError(
        fmt::format("A datagram of {} bytes passes UDP's limit of {}; use fewer "
                    "columns per packet.",
                    payload.size(), kMaxPayloadBytes));
  }
  if (source.address.is_v6 != destination.address.is_v6) {
    throw InputError(
        fmt::format("{} and {} are of two address families; give both as IPv4 or "
                    "both as IPv6.",
                    to_string(source), to_string(destination)));
  }
  build_udp(source, destination, payload, udp_);
  ++identification_;
  const std::size_t ip_header_bytes = source.address.is_v6 ? 40 : 20;
  const auto mtu = static_cast<std::size_t>(options_.mtu);
  if (mtu == 0 || ip_header_bytes + udp_.size() <= mtu) {
    write_packet(host_time, source, destination, udp_, 0, false);
  } else {
    // Every fragment but the last carries a multiple of 8 bytes.
    const std::size_t room = mtu - ip_header_bytes - (source.address.is_v6 ? 8 : 0);
    const std::size_t step = room / 8 * 8;
    for (std::size_t at = 0; at < udp_.size(); at += step) {
      const std::size_t length = std::min(step, udp_.size() - at);
      write_packet(host_time, source, destination, std::span(udp_).subspan(at, length), at,
                   at + length < udp_.size());
    }
  }
  ++datagrams_;
}

void CaptureWriter::write_packet(HostTime host_time, const Endpoint& source,
                                 const Endpoint& destination,
                                 std::span<const std::uint8_t> ip_payload,
                                 std::size_t fragment_offset, bool more_fragments) {
  constexpr std::size_t kRecordHeaderBytes = 16;
  record_.assign(kRecordHeaderBytes, 0);
  Appender out(record_);
  append_ethernet(out, source.address.is_v6);
  const auto append_ip = source.address.is_v6 ? append_ipv6_header : append_ipv4_header;
  append_ip(record_, source, destination, ip_payload.size(), identification_, fragment_offset,
            more_fragments);
  out.bytes(ip_payload);

  std::vector<std::uint8_t> header;
  header.reserve(kRecordHeaderBytes);
  Appender fields(header);
  const auto length = static_cast<std::uint32_t>(record_.size() - kRecordHeaderBytes);
  fields.le32(static_cast<std::uint32_t>(host_time.ns / kNsPerSecond));
  fields.le32(static_cast<std::uint32_t>(host_time.ns % kNsPerSecond));
  fields.le32(length);
  fields.le32(length);
  std::copy(header.begin(), header.end(), record_.begin());
  put(record_);
}

void CaptureWriter::flush() {
  if (std::fflush(stream_) != 0) fail("be written");
}

void CaptureWriter::sync() {
  flush();
  if (fdatasync(fileno(stream_)) != 0) fail("be written to the disk");
}

void CaptureWriter::finish() {
  std::FILE* const stream = std::exchange(stream_, nullptr);
  if (stream == nullptr) return;
  const bool flushed = std::fflush(stream) == 0 && fsync(fileno(stream)) == 0;
  const bool closed = std::fclose(stream) == 0;
  const bool named = options_.in_place || std::rename(part_file_.c_str(), file_.c_str()) == 0;
  if (!flushed || !closed || !named) {
    const int error = errno;
    remove_part();
    errno = error;
    fail("be finished");
  }
}

void CaptureWriter::remove_part() const {
  if (options_.in_place) return;
  std::error_code ignored;
  std::filesystem::remove(part_file_, ignored);
}

void CaptureWriter::put(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) fail("be written");
  bytes_ += bytes.size();
}

void CaptureWriter::fail(const char* action) const {
  throw InputError(
      fmt::format("The capture {} cannot {}: {}; check the folder, its rights and the "
                  "space on its disk.",
                  file_.string(), action, std::strerror(errno)));
}

}  // namespace glint
