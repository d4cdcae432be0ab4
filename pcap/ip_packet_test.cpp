// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/ip_packet.hpp"

#include <gtest/gtest.h>

#include "pcap/test_capture.hpp"

namespace glint {
namespace {

using test::Buffer;
using test::ipv4;
using test::ipv6;
using test::join;

const Buffer payload_bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

Buffer to_buffer(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

TEST(IpPacket, Ipv4FieldsAreRead) {
  const Buffer bytes = ipv4(payload_bytes);
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_EQ(packet.source, test::sender().address);
  EXPECT_EQ(packet.destination, test::receiver().address);
  EXPECT_EQ(packet.protocol, kProtocolUdp);
  EXPECT_FALSE(packet.is_fragment);
  EXPECT_EQ(to_buffer(packet.payload), payload_bytes);
}

TEST(IpPacket, EthernetPaddingIsCutOff) {
  const Buffer bytes = join({ipv4({1, 2}), Buffer(18, 0)});
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_EQ(packet.payload.size(), 2U);
}

TEST(IpPacket, Ipv4OptionsAreSkipped) {
  Buffer bytes = ipv4(join({{1, 1, 1, 1}, payload_bytes}));
  bytes[0] = 0x46;
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_EQ(to_buffer(packet.payload), payload_bytes);
}

TEST(IpPacket, LengthZeroMeansAllThatIsThere) {
  Buffer bytes = ipv4(payload_bytes);
  bytes[2] = bytes[3] = 0;
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_EQ(to_buffer(packet.payload), payload_bytes);
}

TEST(IpPacket, Ipv4FragmentFieldsAreRead) {
  const Buffer bytes = ipv4(payload_bytes, 0xABCD, 1480, true);
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_TRUE(packet.is_fragment);
  EXPECT_TRUE(packet.more_fragments);
  EXPECT_EQ(packet.fragment_offset, 1480U);
  EXPECT_EQ(packet.identification, 0xABCDU);
}

TEST(IpPacket, Ipv6ExtensionHeadersAreSkipped) {
  const Buffer hop_by_hop{60, 0, 1, 4, 0, 0, 0, 0};
  const Buffer destination_options{51, 0, 1, 4, 0, 0, 0, 0};
  const Buffer authentication{17, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1};
  const Buffer bytes =
      ipv6(join({hop_by_hop, destination_options, authentication, payload_bytes}), 0);
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_EQ(packet.protocol, kProtocolUdp);
  EXPECT_EQ(to_buffer(packet.payload), payload_bytes);
}

TEST(IpPacket, Ipv6FragmentFieldsAreRead) {
  const Buffer bytes = test::ipv6_fragment(payload_bytes, 0x12345678, 2896, false);
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_TRUE(packet.is_fragment);
  EXPECT_FALSE(packet.more_fragments);
  EXPECT_EQ(packet.fragment_offset, 2896U);
  EXPECT_EQ(packet.identification, 0x12345678U);
  EXPECT_EQ(to_buffer(packet.payload), payload_bytes);
}

TEST(IpPacket, Ipv6FragmentThatIsTheWholeIsNoFragment) {
  const Buffer bytes = test::ipv6_fragment(payload_bytes, 1, 0, false);
  IpPacket packet;
  ASSERT_EQ(parse_ip(bytes, packet), ParseStatus::kOk);
  EXPECT_FALSE(packet.is_fragment);
}

TEST(IpPacket, EveryCutPacketIsTruncated) {
  for (const Buffer& whole : {ipv4(payload_bytes), ipv6(payload_bytes)}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      IpPacket packet;
      EXPECT_EQ(parse_ip(Bytes(whole).first(size), packet), ParseStatus::kTruncated) << size;
    }
  }
}

TEST(IpPacket, ContradictingLengthsAreMalformed) {
  IpPacket packet;
  Buffer short_header = ipv4(payload_bytes);
  short_header[0] = 0x44;
  EXPECT_EQ(parse_ip(short_header, packet), ParseStatus::kMalformed);
  Buffer short_total = ipv4(payload_bytes);
  short_total[3] = 19;
  EXPECT_EQ(parse_ip(short_total, packet), ParseStatus::kMalformed);
  const Buffer long_extension = ipv6(join({{17, 200, 1, 4, 0, 0, 0, 0}, payload_bytes}), 0);
  EXPECT_EQ(parse_ip(long_extension, packet), ParseStatus::kMalformed);
}

TEST(IpPacket, OtherVersionsAreOther) {
  IpPacket packet;
  EXPECT_EQ(parse_ip(Buffer(40, 0x50), packet), ParseStatus::kOther);
}

TEST(UdpDatagram, PortsAndPayloadAreRead) {
  const Buffer bytes = test::udp(payload_bytes);
  UdpDatagram datagram;
  ASSERT_EQ(parse_udp(bytes, datagram), ParseStatus::kOk);
  EXPECT_EQ(datagram.source_port, 1111);
  EXPECT_EQ(datagram.destination_port, 7502);
  EXPECT_EQ(to_buffer(datagram.payload), payload_bytes);
}

TEST(UdpDatagram, WrongLengthsAreRejected) {
  UdpDatagram datagram;
  Buffer bytes = test::udp(payload_bytes);
  EXPECT_EQ(parse_udp(Bytes(bytes).first(17), datagram), ParseStatus::kTruncated);
  EXPECT_EQ(parse_udp(Bytes(bytes).first(7), datagram), ParseStatus::kMalformed);
  bytes[5] = 7;
  EXPECT_EQ(parse_udp(bytes, datagram), ParseStatus::kMalformed);
}

}  // namespace
}  // namespace glint
