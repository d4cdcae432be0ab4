// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Topics map and image.
#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "daemon/steady_clock.hpp"
#include "daemon/subscriptions.hpp"
#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using std::chrono_literals::operator""s;
using test::TestDaemon;

/// The tiles that a client holds after the notifications so far: the points of each.
struct HeldMap {
  std::map<std::vector<int>, Json> tiles;
  std::uint64_t revision = 0;
  bool complete = false;

  void take(const Json& params) {
    if (params["anew"].get<bool>()) tiles.clear();
    for (const Json& index : params["removed"]) tiles.erase(index.get<std::vector<int>>());
    for (const Json& tile : params["tiles"]) {
      Json& held = tiles[tile["index"].get<std::vector<int>>()];
      if (!tile["continued"].get<bool>()) held = Json::array();
      held.insert(held.end(), tile["points"].begin(), tile["points"].end());
    }
    revision = params["revision"];
    complete = !params["more"].get<bool>();
  }
};

HeldMap fetched(Client& client, Json params) {
  HeldMap map;
  do {
    Json page = client.call("get_map", params);
    page["anew"] = false;
    page["more"] = page.contains("next_cursor");
    map.take(page);
    if (page.contains("next_cursor")) params["cursor"] = page["next_cursor"];
  } while (!map.complete);
  return map;
}

constexpr int kScans = 20;

/// Scans `begin` to `end` of kScans, each when the one before has its pose: the queue is short.
void feed(TestDaemon& daemon, const std::vector<test::Bytes>& packets, int begin, int end) {
  const auto per_scan = static_cast<std::ptrdiff_t>(packets.size()) / kScans;
  for (int scan = begin; scan < end; ++scan) {
    daemon.feed({packets.begin() + scan * per_scan, packets.begin() + (scan + 1) * per_scan});
    ASSERT_TRUE(daemon.wait_for(
        "get_status", [&](const Json& s) { return s["counters"]["poses"].get<int>() >= scan; }));
  }
}

TEST(MapTopicTest, WhoTakesWhatIsToldHoldsWhatGetMapSays) {
  TestDaemon daemon;
  Client watching(daemon.address());
  Client asking(daemon.address());
  const Json query{{"encoding", "json"}, {"voxel_m", 0.05}};
  Json params = query;
  params["topics"] = {"map"};
  params["rate_hz"] = 50;
  const Json echo = watching.call("subscribe", params);
  EXPECT_EQ(echo["settings"]["map"],
            (Json{{"rate_hz", 2.0}, {"voxel_m", 0.05}, {"encoding", "json"}}));
  const auto packets = test::room_packets(daemon.info(), kScans);
  feed(daemon, packets, 0, kScans / 2);
  HeldMap held;
  while (held.revision == 0 || !held.complete) {
    held.take(watching.next_message(10s).at("params"));
  }
  EXPECT_FALSE(held.tiles.empty());
  feed(daemon, packets, kScans / 2, kScans);
  int messages = 0;
  while (held.revision < fetched(asking, query).revision || !held.complete) {
    const Json message = watching.next_message(10s);
    EXPECT_FALSE(message["params"]["anew"].get<bool>()) << "what is known is not told again";
    held.take(message["params"]);
    ++messages;
  }
  EXPECT_GE(messages, 1);
  EXPECT_EQ(held.tiles, fetched(asking, query).tiles);
}

TEST(MapTopicTest, WrongParametersAreRefusedAndNothingChanges) {
  TestDaemon daemon;
  Client client(daemon.address());
  const auto refused_for = [&](const Json& params) {
    try {
      client.call("subscribe", params);
    } catch (const ReplyError& error) {
      return error.error()["data"]["field"].get<std::string>();
    }
    return std::string();
  };
  EXPECT_EQ(refused_for({{"topics", {"map", "pose"}}, {"region", 3}}), "region");
  EXPECT_EQ(refused_for({{"topics", {"map", "image"}}, {"kind", "xray"}}), "kind");
  EXPECT_EQ(client.call("unsubscribe", {{"topics", {"events"}}})["topics"], Json::array());
}

/// A subscription without a connection: what is not taken waits.
class ToldByWorkerTest : public testing::Test {
 protected:
  ~ToldByWorkerTest() override {
    // Queries that are at work come back first.
    run_until([] { return false; }, 0.2);
  }

  template <class Done>
  bool run_until(Done done, double seconds = 10.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!done() && std::chrono::steady_clock::now() < end) {
      io_.restart();
      io_.run_for(std::chrono::milliseconds(5));
    }
    return done();
  }
  /// As many seconds later.
  void tick(double seconds) {
    now_ns_ += static_cast<std::int64_t>(seconds * 1e9);
    subscriptions_.tick(now_ns_);
  }
  Json take() {
    const auto line = subscriptions_.next_line();
    return line ? Json::parse(*line)["params"] : Json();
  }
  void feed_one_scan() {
    feed(daemon_, packets_, fed_, fed_ + 1);
    ++fed_;
  }

  boost::asio::io_context io_;
  TestDaemon daemon_;
  Api api_{io_, daemon_.runtime(), Config{}};
  ServerCounters counters_;
  int lines_ = 0;
  Subscriptions subscriptions_{api_, counters_, [this] { ++lines_; }};
  const std::vector<test::Bytes> packets_ = test::room_packets(daemon_.info(), kScans);
  int fed_ = 0;
  std::int64_t now_ns_ = steady_now_ns();
};

TEST_F(ToldByWorkerTest, ASlowClientMissesImagesAndIsToldHowMany) {
  subscriptions_.subscribe({{"topics", {"image"}}, {"kind", "signal"}});
  tick(0.0);
  for (int i = 0; i < 4; ++i) feed_one_scan();
  ASSERT_TRUE(run_until([&] { return lines_ == 1; }));
  for (int i = 0; i < 3; ++i) tick(1.1);
  EXPECT_EQ(counters_.missed_notifications, 3U);
  const Json first = take();
  EXPECT_EQ(first["kind"], "signal");
  EXPECT_EQ(first["seq"], 0);
  EXPECT_FALSE(first["png"].get<std::string>().empty());
  EXPECT_TRUE(take().is_null());
  feed_one_scan();
  feed_one_scan();
  tick(1.1);
  ASSERT_TRUE(run_until([&] { return lines_ == 2; }));
  const Json second = take();
  EXPECT_EQ(second["seq"], 1);
  EXPECT_EQ(second["missed"], 3);
  EXPECT_GT(second["t_ns"], first["t_ns"]);
  // No new scan, nothing to show.
  tick(1.1);
  EXPECT_FALSE(run_until([&] { return lines_ == 3; }, 0.3));
}

TEST_F(ToldByWorkerTest, WhoUnsubscribesIsToldNothingMore) {
  subscriptions_.subscribe({{"topics", {"map"}}});
  for (int i = 0; i < 4; ++i) feed_one_scan();
  tick(0.0);
  subscriptions_.unsubscribe({{"topics", {"map"}}});
  EXPECT_FALSE(run_until([&] { return lines_ > 0; }, 0.3));
  EXPECT_TRUE(take().is_null());
}

}  // namespace
}  // namespace glint::daemon
