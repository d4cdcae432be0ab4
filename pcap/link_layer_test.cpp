// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/link_layer.hpp"

#include <gtest/gtest.h>

#include "pcap/test_capture.hpp"

namespace glint {
namespace {

using test::Buffer;
using test::ethernet;
using test::join;

const Buffer ip_bytes{0x45, 1, 2, 3};

void expect_ip(LinkType type, const Buffer& record) {
  Bytes rest = record;
  ASSERT_EQ(strip_link_header(type, rest), LinkStatus::kIp);
  EXPECT_EQ(Buffer(rest.begin(), rest.end()), ip_bytes);
}

TEST(LinkLayer, EthernetHeaderIsStripped) {
  expect_ip(LinkType::kEthernet, ethernet(ip_bytes));
  expect_ip(LinkType::kEthernet, ethernet(ip_bytes, 0x86DD));
}

TEST(LinkLayer, VlanTagsAreStrippedSingleAndStacked) {
  const Buffer customer = join({{0, 5, 0x08, 0x00}, ip_bytes});
  expect_ip(LinkType::kEthernet, ethernet(customer, 0x8100));
  expect_ip(LinkType::kEthernet, ethernet(join({{0, 6, 0x81, 0x00}, customer}), 0x88A8));
  expect_ip(LinkType::kEthernet, ethernet(join({{0, 6, 0x81, 0x00}, customer}), 0x9100));
}

TEST(LinkLayer, LinuxCookedHeadersAreStripped) {
  expect_ip(LinkType::kLinuxCooked, join({Buffer(14, 0), {0x08, 0x00}, ip_bytes}));
  expect_ip(LinkType::kLinuxCooked,
            join({Buffer(14, 0), {0x81, 0x00, 0, 5, 0x86, 0xDD}, ip_bytes}));
  expect_ip(LinkType::kLinuxCooked2, join({{0x08, 0x00}, Buffer(18, 0), ip_bytes}));
}

TEST(LinkLayer, LoopbackFamilyOfEitherByteOrderIsStripped) {
  expect_ip(LinkType::kLoopback, join({{2, 0, 0, 0}, ip_bytes}));
  expect_ip(LinkType::kLoopback, join({{0, 0, 0, 30}, ip_bytes}));
}

TEST(LinkLayer, RawIpIsLeftAsItIs) { expect_ip(LinkType::kRawIp, ip_bytes); }

TEST(LinkLayer, OtherProtocolsAreNoIp) {
  const Buffer arp = ethernet(Buffer(28, 0), 0x0806);
  Bytes rest = arp;
  EXPECT_EQ(strip_link_header(LinkType::kEthernet, rest), LinkStatus::kOther);
}

TEST(LinkLayer, EveryCutHeaderIsTruncated) {
  const Buffer tagged = ethernet({0, 5, 0x08, 0x00}, 0x8100);
  for (std::size_t size = 0; size < tagged.size(); ++size) {
    Bytes cut = Bytes(tagged).first(size);
    EXPECT_EQ(strip_link_header(LinkType::kEthernet, cut), LinkStatus::kTruncated) << size;
  }
  const Buffer header(19, 0);
  for (const LinkType type : {LinkType::kLinuxCooked2, LinkType::kLinuxCooked}) {
    Bytes cut = Bytes(header).first(type == LinkType::kLinuxCooked ? 15 : 19);
    EXPECT_EQ(strip_link_header(type, cut), LinkStatus::kTruncated);
  }
  Bytes cut = Bytes(header).first(3);
  EXPECT_EQ(strip_link_header(LinkType::kLoopback, cut), LinkStatus::kTruncated);
}

TEST(LinkLayer, UnknownLinkTypesAreNull) { EXPECT_FALSE(link_type_of(105).has_value()); }

}  // namespace
}  // namespace glint
