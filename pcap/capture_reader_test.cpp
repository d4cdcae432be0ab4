// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/capture_reader.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "driver/core/error.hpp"
#include "pcap/test_capture.hpp"

namespace glint {
namespace {

using test::Buffer;
using test::ethernet;
using test::ipv4;
using test::ipv6;
using test::join;
using test::PcapBytes;
using test::TempDir;
using test::udp;
using ::testing::HasSubstr;

struct Read {
  HostTime time;
  Endpoint source;
  Endpoint destination;
  Buffer payload;
};

std::vector<Read> read_all(CaptureReader& reader) {
  std::vector<Read> all;
  while (const Datagram* d = reader.next()) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(d->payload.data());
    all.push_back({d->host_time, d->source, d->destination, {bytes, bytes + d->payload.size()}});
  }
  return all;
}

class CaptureReaderTest : public ::testing::Test {
 protected:
  std::vector<Read> read(const PcapBytes& capture) {
    capture.save(file_);
    return read_file();
  }
  std::vector<Read> read_file() {
    CaptureReader reader(file_);
    auto all = read_all(reader);
    counters_ = reader.counters();
    problem_ = reader.problem();
    return all;
  }
  std::string complaint() {
    try {
      CaptureReader reader(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }

  const TempDir dir_;
  const std::filesystem::path file_ = dir_ / "capture.pcap";
  const Buffer payload_ = test::pattern(100, 1);
  CaptureCounters counters_;
  std::string problem_;
};

TEST_F(CaptureReaderTest, EveryLinkTypeIsRead) {
  const Buffer v4 = ipv4(udp(payload_));
  const Buffer v6 = ipv6(udp(payload_, true));
  const std::vector<std::tuple<std::uint32_t, Buffer, bool>> cases = {
      {test::kLinkEthernet, ethernet(v4), false},
      {test::kLinkEthernet, ethernet(v6, 0x86DD), true},
      {test::kLinkEthernet, ethernet(join({{0, 5, 0x81, 0, 0, 6, 8, 0}, v4}), 0x88A8), false},
      {test::kLinkCooked, join({Buffer(14, 0), {0x08, 0x00}, v4}), false},
      {test::kLinkCooked2, join({{0x86, 0xDD}, Buffer(18, 0), v6}), true},
      {test::kLinkRaw, v4, false},
      {test::kLinkRaw, v6, true},
      {test::kLinkIpv4, v4, false},
      {test::kLinkIpv6, v6, true},
      {test::kLinkNull, join({{2, 0, 0, 0}, v4}), false},
      {test::kLinkLoop, join({{0, 0, 0, 24}, v6}), true},
  };
  for (const auto& [link_type, record, is_v6] : cases) {
    PcapBytes capture(link_type);
    capture.record(1'234'567'890'123'456'789, record);
    const auto all = read(capture);
    ASSERT_EQ(all.size(), 1U) << "link type " << link_type;
    EXPECT_EQ(all[0].time.ns, 1'234'567'890'123'456'789);
    EXPECT_EQ(all[0].source, test::sender(is_v6));
    EXPECT_EQ(all[0].destination, test::receiver(is_v6));
    EXPECT_EQ(all[0].payload, payload_);
  }
}

TEST_F(CaptureReaderTest, MicrosecondTimesAreRead) {
  PcapBytes capture(test::kLinkEthernet, false);
  capture.record(1'234'567'890'123'456'000, ethernet(ipv4(udp(payload_))));
  EXPECT_EQ(read(capture).at(0).time.ns, 1'234'567'890'123'456'000);
}

TEST_F(CaptureReaderTest, PcapngIsRead) {
  const Buffer packet = ethernet(ipv4(udp(payload_)));
  test::save(file_, test::pcapng({packet, packet}));
  const auto all = read_file();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1].time.ns, 2'000'000);
  EXPECT_EQ(all[1].payload, payload_);
}

TEST_F(CaptureReaderTest, FragmentsOfBothVersionsArePutTogether) {
  for (const bool is_v6 : {false, true}) {
    const Buffer payload = test::pattern(2000, 3);
    const Buffer whole = udp(payload, is_v6);
    const Buffer first(whole.begin(), whole.begin() + 1480);
    const Buffer second(whole.begin() + 1480, whole.end());
    PcapBytes capture(test::kLinkRaw);
    capture.record(
        1000, is_v6 ? test::ipv6_fragment(second, 7, 1480, false) : ipv4(second, 7, 1480, false));
    capture.record(2000, is_v6 ? test::ipv6_fragment(first, 7, 0, true) : ipv4(first, 7, 0, true));
    const auto all = read(capture);
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0].payload, payload);
    EXPECT_EQ(all[0].time.ns, 2000);
    EXPECT_EQ(counters_.fragments, 2U);
    EXPECT_EQ(counters_.reassembly.datagrams, 1U);
  }
}

TEST_F(CaptureReaderTest, RecordsLongerThanTheSnapLengthAreReadWhole) {
  const Buffer payload = test::pattern(12608, 1);
  PcapBytes capture(test::kLinkEthernet, true, 1514);
  capture.record(0, ethernet(ipv4(udp(payload))));
  capture.record(1, ethernet(ipv4(udp(payload_))));
  const auto all = read(capture);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].payload, payload);
  EXPECT_EQ(all[1].payload, payload_);
}

TEST_F(CaptureReaderTest, RecordsCutByTheSnapLengthAreCounted) {
  const Buffer whole = ethernet(ipv4(udp(payload_)));
  PcapBytes capture(test::kLinkEthernet);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    capture.record(0, Buffer(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)),
                   whole.size());
  }
  EXPECT_TRUE(read(capture).empty());
  EXPECT_EQ(counters_.truncated_records, whole.size());
}

TEST_F(CaptureReaderTest, OtherProtocolsAndMalformedRecordsAreCounted) {
  PcapBytes capture(test::kLinkEthernet);
  capture.record(0, ethernet(Buffer(28, 0), 0x0806));                // ARP
  capture.record(0, ethernet(ipv4(Buffer(40, 0), 0, 0, false, 6)));  // TCP
  capture.record(0, ethernet(ipv4(Buffer(40, 0), 9, 0, true, 6)));   // TCP fragment
  capture.record(0, ethernet(ipv4({0, 1, 0, 2, 0, 3, 0, 0})));       // UDP length 3
  capture.record(0, ethernet(ipv4(udp(payload_))));
  EXPECT_EQ(read(capture).size(), 1U);
  EXPECT_EQ(counters_.other_protocols, 3U);
  EXPECT_EQ(counters_.malformed_records, 1U);
  EXPECT_EQ(counters_.whole_datagrams, 1U);
  EXPECT_EQ(counters_.records, 5U);
}

TEST_F(CaptureReaderTest, CaptureThatBreaksOffIsUsedAndReported) {
  PcapBytes capture(test::kLinkEthernet);
  for (int i = 0; i < 3; ++i) capture.record(i, ethernet(ipv4(udp(payload_))));
  capture.bytes().resize(capture.bytes().size() - 10);
  EXPECT_EQ(read(capture).size(), 2U);
  EXPECT_THAT(problem_, HasSubstr("breaks off after 2 records"));
}

TEST_F(CaptureReaderTest, PcapngThatBreaksOffIsUsedAndReported) {
  const Buffer packet = ethernet(ipv4(udp(payload_)));
  Buffer bytes = test::pcapng({packet, packet});
  bytes.resize(bytes.size() - 20);
  test::save(file_, bytes);
  EXPECT_EQ(read_file().size(), 1U);
  EXPECT_THAT(problem_, HasSubstr("breaks off"));
}

TEST_F(CaptureReaderTest, CaptureWithoutRecordsHasNoDatagrams) {
  EXPECT_TRUE(read(PcapBytes(test::kLinkEthernet)).empty());
  EXPECT_EQ(problem_, "");
}

TEST_F(CaptureReaderTest, MissingFileIsNamed) {
  EXPECT_THAT(complaint(), AllOf(HasSubstr(file_.string()), HasSubstr("No such file")));
}

TEST_F(CaptureReaderTest, FolderIsNamed) {
  std::filesystem::create_directory(file_);
  EXPECT_THAT(complaint(), AllOf(HasSubstr(file_.string()), HasSubstr("directory")));
}

TEST_F(CaptureReaderTest, ForeignAndEmptyFilesAreNoCaptures) {
  test::save(file_, {});
  EXPECT_THAT(complaint(), HasSubstr("no pcap or pcapng capture"));
  const std::string text = "{\"this\": \"is metadata, not a capture\"}";
  test::save(file_, {text.begin(), text.end()});
  EXPECT_THAT(complaint(), HasSubstr("no pcap or pcapng capture"));
}

TEST_F(CaptureReaderTest, UnknownLinkTypeIsNamed) {
  PcapBytes(test::kLinkWifi).save(file_);
  EXPECT_THAT(complaint(), AllOf(HasSubstr("link type"), HasSubstr("IEEE802_11")));
}

TEST_F(CaptureReaderTest, FlippedBitsNeverCrash) {
  PcapBytes whole(test::kLinkEthernet);
  const Buffer large = udp(test::pattern(3000, 1));
  const std::ptrdiff_t half = 1480;
  for (int i = 0; i < 4; ++i) {
    whole.record(i, ethernet(ipv4(udp(payload_))));
    whole.record(i, ethernet(ipv4({large.begin(), large.begin() + half}, 1, 0, true)));
    whole.record(i, ethernet(ipv4({large.begin() + half, large.end()}, 1, 1480, false)));
    whole.record(i, ethernet(test::ipv6_fragment(large, 3, 0, true), 0x86DD));
  }
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    PcapBytes damaged = whole;
    for (int flips = 0; flips < 20; ++flips) {
      // The file header stays: without it there is nothing to read.
      const std::size_t at = 24 + random() % (damaged.bytes().size() - 24);
      damaged.bytes()[at] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    }
    read(damaged);
    EXPECT_EQ(counters_.records, counters_.whole_datagrams + counters_.fragments +
                                     counters_.other_protocols + counters_.truncated_records +
                                     counters_.malformed_records);
  }
}

}  // namespace
}  // namespace glint
