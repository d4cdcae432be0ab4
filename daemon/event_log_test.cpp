// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/event_log.hpp"

#include <gtest/gtest.h>

#include "daemon/subscriptions.hpp"
#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using test::TestDaemon;
using namespace std::chrono_literals;

Event event(int value) { return {"sensor", 0, Json{{"value", value}}}; }

TEST(EventLogTest, AReaderGetsEveryEventInOrder) {
  EventLog log;
  log.post(event(1));
  log.post(event(2));
  std::uint64_t cursor = 0;
  EXPECT_EQ(log.next(cursor)->fields["value"], 1);
  EXPECT_EQ(log.next(cursor)->fields["value"], 2);
  EXPECT_FALSE(log.next(cursor).has_value());
  EXPECT_EQ(cursor, log.end());
}

TEST(EventLogTest, TheOldestEventsGoAndTheCursorTellsHowMany) {
  EventLog log(3);
  for (int i = 0; i < 10; ++i) log.post(event(i));
  std::uint64_t cursor = 2;
  EXPECT_EQ(log.next(cursor)->fields["value"], 7);
  EXPECT_EQ(cursor, 8U);
}

TEST(EventLogTest, AnEventGetsTheTimeOfThisMachineUnlessItHasOne) {
  EventLog log;
  log.post(event(1));
  log.post({"clock", 0, Json{{"t_host_ns", 77}}});
  std::uint64_t cursor = 0;
  EXPECT_GT(log.next(cursor)->fields["t_host_ns"].get<std::int64_t>(), 1'700'000'000'000'000'000);
  EXPECT_EQ(log.next(cursor)->fields["t_host_ns"], 77);
}

TEST(EventLogTest, SubscribersAreToldWhatHappensFromThenOn) {
  TestDaemon daemon;
  daemon.runtime().events().post(event(1));
  Client client(daemon.address());
  const Json echo = client.call("subscribe", {{"topics", {"events"}}});
  EXPECT_EQ(echo["topics"], Json{"events"});
  daemon.runtime().events().post(event(2));
  const Json message = client.next_message(5s);
  EXPECT_EQ(message["method"], "event");
  EXPECT_EQ(message["params"]["kind"], "sensor");
  EXPECT_EQ(message["params"]["sensor"], 0);
  EXPECT_EQ(message["params"]["value"], 2);
  EXPECT_EQ(message["params"]["seq"], 0);
  EXPECT_EQ(message["params"]["missed"], 0);
}

TEST(EventLogTest, ASubscriberThatIsTooLateLearnsHowManyItMissed) {
  TestDaemon daemon;
  boost::asio::io_context io;
  Api api(io, daemon.runtime(), {});
  ServerCounters counters;
  Subscriptions subscriptions(api, counters, [] {});
  subscriptions.subscribe({{"topics", {"events"}}});
  for (int i = 0; i < 300; ++i) daemon.runtime().events().post(event(i));
  const Json params = Json::parse(*subscriptions.next_line())["params"];
  EXPECT_EQ(params["value"], 44);
  EXPECT_EQ(params["seq"], 44);
  EXPECT_EQ(params["missed"], 44);
  EXPECT_EQ(Json::parse(*subscriptions.next_line())["params"]["seq"], 45);
  subscriptions.unsubscribe({{"topics", {"events"}}});
  EXPECT_FALSE(subscriptions.next_line().has_value());
}

}  // namespace
}  // namespace glint::daemon
