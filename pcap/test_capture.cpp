// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/test_capture.hpp"

#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp is POSIX.

#include <fstream>
#include <stdexcept>

#include "pcap/internet_checksum.hpp"

namespace glint::test {
namespace {

void be(Buffer& out, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void le(Buffer& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void append(Buffer& out, const Buffer& more) { out.insert(out.end(), more.begin(), more.end()); }

void append(Buffer& out, const IpAddress& address) {
  out.insert(out.end(), address.bytes.begin(), address.bytes.begin() + (address.is_v6 ? 16 : 4));
}

void block(Buffer& out, std::uint32_t type, const Buffer& body) {
  const std::size_t padding = (4 - body.size() % 4) % 4;
  const std::size_t size = 12 + body.size() + padding;
  le(out, type, 4);
  le(out, size, 4);
  append(out, body);
  out.resize(out.size() + padding);
  le(out, size, 4);
}

}  // namespace

TempDir::TempDir() {
  std::string name = (std::filesystem::temp_directory_path() / "glint-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TempDir::~TempDir() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Buffer join(std::initializer_list<Buffer> pieces) {
  Buffer joined;
  for (const Buffer& piece : pieces) append(joined, piece);
  return joined;
}

Buffer pattern(std::size_t size, unsigned seed) {
  Buffer bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 251 + seed);
  return bytes;
}

Endpoint sender(bool is_v6) {
  return {*IpAddress::parse(is_v6 ? "2001:db8::1" : "192.0.2.1"), 1111};
}

Endpoint receiver(bool is_v6) {
  return {*IpAddress::parse(is_v6 ? "2001:db8::2" : "192.0.2.2"), 7502};
}

Buffer udp(const Buffer& payload, bool is_v6) {
  Buffer out;
  be(out, sender().port, 2);
  be(out, receiver().port, 2);
  be(out, 8 + payload.size(), 2);
  be(out, 0, 2);
  append(out, payload);
  const std::uint16_t sum = udp_checksum(sender(is_v6).address, receiver(is_v6).address, out);
  out[6] = static_cast<std::uint8_t>(sum >> 8);
  out[7] = static_cast<std::uint8_t>(sum & 0xFF);
  return out;
}

Buffer ipv4(const Buffer& payload, std::uint16_t id, std::size_t offset, bool more,
            std::uint8_t protocol) {
  Buffer out{0x45, 0};
  be(out, 20 + payload.size(), 2);
  be(out, id, 2);
  be(out, (more ? 0x2000U : 0U) | offset / 8, 2);
  append(out, Buffer{64, protocol, 0, 0});
  append(out, sender().address);
  append(out, receiver().address);
  append(out, payload);
  return out;
}

Buffer ipv6(const Buffer& payload, std::uint8_t next_header) {
  Buffer out{0x60, 0, 0, 0};
  be(out, payload.size(), 2);
  append(out, Buffer{next_header, 64});
  append(out, sender(true).address);
  append(out, receiver(true).address);
  append(out, payload);
  return out;
}

Buffer ipv6_fragment(const Buffer& payload, std::uint32_t id, std::size_t offset, bool more) {
  Buffer header{17, 0};
  be(header, offset | (more ? 1U : 0U), 2);
  be(header, id, 4);
  return ipv6(join({header, payload}), 44);
}

Buffer ethernet(const Buffer& payload, std::uint16_t ether_type) {
  Buffer out(12, 2);
  be(out, ether_type, 2);
  append(out, payload);
  return out;
}

PcapBytes::PcapBytes(std::uint32_t link_type, bool nanoseconds, std::uint32_t snap_length)
    : nanoseconds_(nanoseconds) {
  le(bytes_, nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4);
  le(bytes_, 2, 2);
  le(bytes_, 4, 2);
  le(bytes_, 0, 8);
  le(bytes_, snap_length, 4);
  le(bytes_, link_type, 4);
}

void PcapBytes::record(std::int64_t time_ns, const Buffer& bytes, std::size_t original_size) {
  const auto time = static_cast<std::uint64_t>(time_ns);
  le(bytes_, time / 1'000'000'000, 4);
  le(bytes_, time % 1'000'000'000 / (nanoseconds_ ? 1 : 1000), 4);
  le(bytes_, bytes.size(), 4);
  le(bytes_, original_size == 0 ? bytes.size() : original_size, 4);
  append(bytes_, bytes);
}

void PcapBytes::save(const std::filesystem::path& file) const { test::save(file, bytes_); }

Buffer pcapng(const std::vector<Buffer>& packets) {
  Buffer out;
  Buffer section;
  le(section, 0x1A2B3C4D, 4);
  le(section, 1, 4);
  le(section, ~std::uint64_t{0}, 8);
  block(out, 0x0A0D0D0A, section);
  Buffer interface;
  le(interface, kLinkEthernet, 4);
  le(interface, 262144, 4);
  append(interface, Buffer{9, 0, 1, 0, 9, 0, 0, 0});  // if_tsresol: 10^-9 s.
  append(interface, Buffer{0, 0, 0, 0});
  block(out, 1, interface);
  std::uint64_t time_ns = 0;
  for (const Buffer& packet : packets) {
    time_ns += 1'000'000;
    Buffer body;
    le(body, 0, 4);
    le(body, time_ns >> 32, 4);
    le(body, time_ns & 0xFFFFFFFF, 4);
    le(body, packet.size(), 4);
    le(body, packet.size(), 4);
    append(body, packet);
    block(out, 6, body);
  }
  return out;
}

void save(const std::filesystem::path& file, const Buffer& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace glint::test
