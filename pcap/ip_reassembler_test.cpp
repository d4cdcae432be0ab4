// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/ip_reassembler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pcap/test_capture.hpp"

namespace glint {
namespace {

using test::Buffer;

constexpr std::size_t kStep = 1480;

struct Piece {
  std::size_t offset;
  bool more;
  Buffer bytes;
};

std::vector<Piece> split(const Buffer& datagram, std::size_t step = kStep) {
  std::vector<Piece> pieces;
  for (std::size_t at = 0; at < datagram.size(); at += step) {
    const std::size_t end = std::min(at + step, datagram.size());
    pieces.push_back({at, end < datagram.size(),
                      Buffer(datagram.begin() + static_cast<std::ptrdiff_t>(at),
                             datagram.begin() + static_cast<std::ptrdiff_t>(end))});
  }
  return pieces;
}

class IpReassemblerTest : public ::testing::TestWithParam<bool> {
 protected:
  IpPacket packet(const Piece& piece, std::uint32_t id) const {
    IpPacket p;
    p.source = test::sender(GetParam()).address;
    p.destination = test::receiver(GetParam()).address;
    p.protocol = kProtocolUdp;
    p.payload = piece.bytes;
    p.is_fragment = true;
    p.identification = id;
    p.fragment_offset = static_cast<std::uint32_t>(piece.offset);
    p.more_fragments = piece.more;
    return p;
  }
  /// The datagram that the piece completes; empty if none.
  Buffer push(const Piece& piece, std::uint32_t id = 1, std::int64_t time_ns = 0) {
    const Bytes done = reassembler_.push(packet(piece, id), HostTime{time_ns});
    return {done.begin(), done.end()};
  }
  Buffer datagram(unsigned seed, std::size_t size = 8448) const {
    return test::udp(test::pattern(size, seed), GetParam());
  }
  const ReassemblyCounters& counters() const { return reassembler_.counters(); }

  IpReassembler reassembler_{{}};
};

INSTANTIATE_TEST_SUITE_P(Versions, IpReassemblerTest, ::testing::Values(false, true),
                         [](const auto& p) { return p.param ? "Ipv6" : "Ipv4"; });

TEST_P(IpReassemblerTest, FragmentsInAnyOrderMakeTheDatagram) {
  std::mt19937 random(1);
  for (unsigned round = 0; round < 20; ++round) {
    const Buffer whole = datagram(round);
    auto pieces = split(whole);
    std::ranges::shuffle(pieces, random);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      EXPECT_TRUE(push(pieces[i], round).empty());
    }
    EXPECT_EQ(push(pieces.back(), round), whole);
  }
  EXPECT_EQ(counters().datagrams, 20U);
  EXPECT_EQ(reassembler_.datagrams_in_flight(), 0U);
  EXPECT_EQ(reassembler_.bytes_in_flight(), 0U);
}

TEST_P(IpReassemblerTest, InterleavedDatagramsDoNotMix) {
  const Buffer a = datagram(1);
  const Buffer b = datagram(2);
  const auto pieces_a = split(a);
  const auto pieces_b = split(b);
  Buffer done_a;
  Buffer done_b;
  for (std::size_t i = 0; i < pieces_a.size(); ++i) {
    done_a = push(pieces_a[i], 1);
    done_b = push(pieces_b[i], 2);
  }
  EXPECT_EQ(done_a, a);
  EXPECT_EQ(done_b, b);
}

TEST_P(IpReassemblerTest, DuplicatesAreCountedAndIgnored) {
  const Buffer whole = datagram(1);
  const auto pieces = split(whole);
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    push(pieces[i]);
    push(pieces[i]);
  }
  EXPECT_EQ(push(pieces.back()), whole);
  EXPECT_EQ(counters().duplicate_fragments, pieces.size() - 1);
}

TEST_P(IpReassemblerTest, StrayFragmentBeforeOrAmongDoesNotPoisonTheDatagram) {
  const Buffer whole = datagram(1);
  const auto pieces = split(whole);
  const auto strays = split(datagram(99));
  // Any one fragment of an earlier datagram, seen at any moment.
  std::uint32_t id = 0;
  for (const Piece& stray : strays) {
    for (std::size_t when = 0; when < pieces.size(); ++when) {
      ++id;
      Buffer done;
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (i == when) push(stray, id);
        done = push(pieces[i], id);
      }
      EXPECT_EQ(done, whole) << "stray at " << stray.offset << " before piece " << when;
    }
  }
  EXPECT_EQ(counters().datagrams, id);
  EXPECT_EQ(counters().stray_fragments, id);
}

TEST_P(IpReassemblerTest, OverlappingFragmentOfAnotherSizeDoesNotPoisonTheDatagram) {
  const Buffer whole = datagram(1);
  push({8, true, Buffer(4000, 0xEE)});
  push({1480, false, Buffer(13, 0xEE)});
  Buffer done;
  for (const Piece& piece : split(whole)) done = push(piece);
  EXPECT_EQ(done, whole);
  EXPECT_EQ(counters().stray_fragments, 2U);
}

TEST_P(IpReassemblerTest, WrongChecksumGivesNoDatagram) {
  Buffer whole = datagram(1);
  whole[100] ^= 1U;
  for (const Piece& piece : split(whole)) EXPECT_TRUE(push(piece).empty());
  reassembler_.finish();
  EXPECT_EQ(counters().bad_checksums, 1U);
  EXPECT_EQ(counters().datagrams, 0U);
}

TEST_P(IpReassemblerTest, DatagramWithoutChecksumIsTaken) {
  Buffer whole = datagram(1);
  whole[6] = whole[7] = 0;
  Buffer done;
  for (const Piece& piece : split(whole)) done = push(piece);
  EXPECT_EQ(done, whole);
}

TEST_P(IpReassemblerTest, IncompleteDatagramTimesOut) {
  const auto pieces = split(datagram(1));
  push(pieces[0], 1, 0);
  push(pieces[1], 2, kNsPerSecond + 1);
  EXPECT_EQ(counters().timed_out, 1U);
  EXPECT_EQ(reassembler_.datagrams_in_flight(), 1U);
  reassembler_.finish();
  EXPECT_EQ(counters().timed_out, 2U);
  EXPECT_EQ(reassembler_.bytes_in_flight(), 0U);
}

TEST_P(IpReassemblerTest, NumberOfDatagramsInFlightIsLimited) {
  const auto pieces = split(datagram(1));
  const ReassemblyLimits limits;
  for (std::uint32_t id = 0; id < limits.max_datagrams + 10; ++id) push(pieces[0], id);
  EXPECT_EQ(reassembler_.datagrams_in_flight(), limits.max_datagrams);
  EXPECT_EQ(counters().evicted, 10U);
}

TEST_P(IpReassemblerTest, BytesInFlightAreLimited) {
  ReassemblyLimits limits;
  limits.max_bytes = 10'000;
  IpReassembler reassembler(limits);
  const auto pieces = split(datagram(1));
  for (std::uint32_t id = 0; id < 20; ++id) {
    static_cast<void>(reassembler.push(packet(pieces[0], id), HostTime{}));
    EXPECT_LE(reassembler.bytes_in_flight(), limits.max_bytes);
  }
  EXPECT_GT(reassembler.counters().evicted, 0U);
}

TEST_P(IpReassemblerTest, FragmentsOfOneDatagramAreLimited) {
  const ReassemblyLimits limits;
  for (unsigned i = 0; i <= limits.max_fragments; ++i) push({8, true, test::pattern(16, i)});
  EXPECT_EQ(counters().evicted, 0U);  // 256 distinct patterns, the last repeats the first.
  EXPECT_EQ(counters().duplicate_fragments, 1U);
  push({16, true, test::pattern(16, 0)});
  EXPECT_EQ(counters().evicted, 1U);
  EXPECT_EQ(reassembler_.datagrams_in_flight(), 0U);
}

TEST_P(IpReassemblerTest, MalformedFragmentsAreCountedAndIgnored) {
  push({0, true, Buffer(13, 1)});
  push({0, true, {}});
  push({65528, false, Buffer(8, 1)});
  EXPECT_EQ(counters().malformed_fragments, 3U);
  EXPECT_EQ(reassembler_.datagrams_in_flight(), 0U);
}

TEST_P(IpReassemblerTest, LargestDatagramIsPutTogether) {
  const Buffer whole = datagram(3, 65507 - (GetParam() ? 20 : 0));
  Buffer done;
  for (const Piece& piece : split(whole, 272)) done = push(piece);
  EXPECT_EQ(done, whole);
}

}  // namespace
}  // namespace glint
