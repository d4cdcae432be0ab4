// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/network_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <vector>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

constexpr int kDatagrams = 20000;

// Sends numbered datagrams through a network and returns the numbers in the order of arrival.
std::vector<int> arrivals(const NetworkFaults& faults, FaultCounts& counts) {
  FaultyNetwork network(faults, 5);
  int next = 0;
  const auto send = [&](RawPacket& packet) {
    if (next == kDatagrams) return SourceStatus::kEnd;
    packet.bytes.resize(sizeof next);
    std::memcpy(packet.bytes.data(), &next, sizeof next);
    packet.host_time = {1000 * next++};
    return SourceStatus::kPacket;
  };
  std::vector<int> order;
  RawPacket packet;
  HostTime last;
  while (network.receive(send, packet) == SourceStatus::kPacket) {
    int number = 0;
    std::memcpy(&number, packet.bytes.data(), sizeof number);
    order.push_back(number);
    EXPECT_GE(packet.host_time, last);
    last = packet.host_time;
  }
  counts = network.counts();
  return order;
}

TEST(FaultyNetwork, AGoodOneChangesNothing) {
  FaultCounts counts;
  const auto order = arrivals({}, counts);
  ASSERT_EQ(order.size(), static_cast<std::size_t>(kDatagrams));
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  EXPECT_EQ(counts.sent, static_cast<std::uint64_t>(kDatagrams));
}

TEST(FaultyNetwork, WhatItDoesIsWhatItCounts) {
  FaultCounts counts;
  const auto order = arrivals({.loss = 0.05, .duplicates = 0.02, .reordering = 0.05}, counts);
  std::map<int, int> copies;
  for (const int number : order) ++copies[number];
  EXPECT_EQ(kDatagrams - copies.size(), counts.lost);
  EXPECT_EQ(order.size() - copies.size(), counts.duplicated);
  EXPECT_NEAR(static_cast<double>(counts.lost), 0.05 * kDatagrams, 150.0);
  EXPECT_NEAR(static_cast<double>(counts.duplicated), 0.02 * kDatagrams, 100.0);
  EXPECT_NEAR(static_cast<double>(counts.delayed), 0.05 * kDatagrams, 150.0);
}

TEST(FaultyNetwork, LateMeansOneToThreeLate) {
  FaultCounts counts;
  const auto order = arrivals({.reordering = 0.02}, counts);
  std::map<int, int> late;
  int highest = -1;
  for (const int number : order) {
    if (number < highest) ++late[highest - number];
    highest = std::max(highest, number);
  }
  int all = 0;
  for (const auto& [by, count] : late) {
    // Neighbours may be late together.
    EXPECT_LE(by, 5);
    all += count;
  }
  EXPECT_NEAR(all, static_cast<double>(counts.delayed), 20.0);
}

TEST(FaultyNetwork, SharesThatAreNoneAreRefused) {
  EXPECT_THROW(FaultyNetwork({.loss = 1.0}, 1), OptionError);
  EXPECT_THROW(FaultyNetwork({.duplicates = -0.1}, 1), OptionError);
}

}  // namespace
}  // namespace glint::synth
