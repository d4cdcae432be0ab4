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

TEST(FaultyNetwork, NoneIsPassedByMoreThanThree) {
  FaultCounts counts;
  const auto order = arrivals({.duplicates = 0.1, .reordering = 0.3}, counts);
  std::vector<std::size_t> first_at(kDatagrams, order.size());
  for (std::size_t i = order.size(); i-- > 0;) first_at[static_cast<std::size_t>(order[i])] = i;
  for (std::size_t number = 0; number + 20 < first_at.size(); ++number) {
    int passed_by = 0;
    for (std::size_t later = number + 1; later < number + 20; ++later) {
      if (first_at[later] < first_at[number]) ++passed_by;
    }
    ASSERT_LE(passed_by, 3) << number;
  }
}

TEST(FaultyNetwork, FaultsChangeWhenToldAndTheObserverSeesEachFate) {
  FaultyNetwork network({}, 5);
  std::map<DatagramFate, int> fates;
  network.set_observer([&](const RawPacket&, DatagramFate fate) { ++fates[fate]; });
  int left = 1000;
  const auto send = [&](RawPacket& packet) {
    packet.host_time = {5};
    return left-- > 0 ? SourceStatus::kPacket : SourceStatus::kEnd;
  };
  RawPacket packet;
  for (int i = 0; i < 500; ++i) ASSERT_EQ(network.receive(send, packet), SourceStatus::kPacket);
  EXPECT_EQ(fates[DatagramFate::kArrives], 500);
  network.set_faults({.loss = 0.5, .delay_ns = 70});
  int arrived = 0;
  for (; network.receive(send, packet) == SourceStatus::kPacket; ++arrived) {
    ASSERT_EQ(packet.host_time.ns, 75);
  }
  EXPECT_NEAR(arrived, 250, 60);
  EXPECT_EQ(fates[DatagramFate::kLost], 500 - arrived);
  EXPECT_EQ(network.counts().lost, static_cast<std::uint64_t>(500 - arrived));
}

TEST(FaultyNetwork, SharesThatAreNoneAreRefused) {
  EXPECT_THROW(FaultyNetwork({.loss = 1.0}, 1), OptionError);
  EXPECT_THROW(FaultyNetwork({.duplicates = -0.1}, 1), OptionError);
  FaultyNetwork network({}, 1);
  EXPECT_THROW(network.set_faults({.delay_ns = -1}), OptionError);
}

}  // namespace
}  // namespace glint::synth
