// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What clients may do to the server, and what they may not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "daemon/subscriptions.hpp"
#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using test::TestDaemon;
using testing::HasSubstr;
using namespace std::chrono_literals;

TEST(ServerTest, AFirstLineThatIsNoJsonGetsOneErrorAndAClose) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.send_raw("GET / HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(client.next_message(5s)["error"]["code"], kParseError);
  EXPECT_THROW(client.next_message(5s), ClientError);
}

TEST(ServerTest, BytesOfAnotherProtocolNeedNoLineFeedToBeRefused) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.send_raw(std::string_view("\x16\x03\x01\x02\x00\x01", 6));
  EXPECT_EQ(client.next_message(5s)["error"]["code"], kParseError);
  EXPECT_THROW(client.next_message(5s), ClientError);
  EXPECT_TRUE(daemon.wait_for("get_status",
                              [](const Json& s) { return s["server"]["junk_clients"] == 1; }));
}

TEST(ServerTest, RequestsBeyondTheRateWaitAndAreAllAnswered) {
  Config config;
  config.server.max_requests_per_s = 20;
  TestDaemon daemon(config);
  Client fast(daemon.address());
  std::string requests;
  for (int i = 0; i < 40; ++i) {
    requests += "{\"id\":" + std::to_string(i) + ",\"method\":\"get_pose\"}\n";
  }
  const auto begin = std::chrono::steady_clock::now();
  fast.send_raw(requests);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(fast.next_message(5s)["id"], i);
  EXPECT_GT(std::chrono::steady_clock::now() - begin, 900ms) << "20 at once, 20 in the next second";
  Client other(daemon.address());
  EXPECT_GT(other.call("get_status")["server"]["throttled_requests"], 0);
}

TEST(ServerTest, LaterJunkGetsAnErrorAndTheConnectionLives) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.call("get_pose");
  client.send_raw("junk\n");
  EXPECT_EQ(client.next_message(5s)["error"]["code"], kParseError);
  EXPECT_NO_THROW(client.call("get_pose"));
}

TEST(ServerTest, AnOversizedLineGetsAnErrorAndAClose) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.send_raw("{\"x\":\"" + std::string(kMaxLineBytes + 100'000, 'x'));
  const Json message = client.next_message(5s);
  EXPECT_EQ(message["error"]["data"]["code"], "TOO_LARGE");
  EXPECT_THROW(client.next_message(5s), ClientError);
}

TEST(ServerTest, BatchesUnknownMethodsAndBadParametersAreToldApart) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.send_raw(
      "{\"id\":1,\"method\":\"fly\"}\r\n"
      "[{\"id\":2,\"method\":\"get_pose\"}]\n"
      "{\"id\":3,\"method\":\"get_pose\",\"params\":{\"frame\":\"world\"}}\n");
  EXPECT_EQ(client.next_message(5s)["error"]["code"], kMethodNotFound);
  EXPECT_EQ(client.next_message(5s)["error"]["code"], kInvalidRequest);
  const Json bad = client.next_message(5s);
  EXPECT_EQ(bad["id"], 3);
  EXPECT_EQ(bad["error"]["code"], kInvalidParams);
  EXPECT_EQ(bad["error"]["data"]["field"], "frame");
}

TEST(ServerTest, ARequestWithoutAnIdGetsNoReply) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.send_raw("{\"method\":\"get_pose\"}\n{\"id\":\"a\",\"method\":\"get_status\"}\n");
  EXPECT_EQ(client.next_message(5s)["id"], "a");
}

TEST(ServerTest, RepliesKeepTheOrderOfRequestsEvenAcrossTheWorker) {
  TestDaemon daemon;
  Client client(daemon.address());
  client.send_raw(
      "{\"id\":1,\"method\":\"get_map\"}\n{\"id\":2,\"method\":\"get_pose\"}\n"
      "{\"id\":3,\"method\":\"get_map\"}\n{\"id\":4,\"method\":\"get_pose\"}\n");
  for (int id = 1; id <= 4; ++id) EXPECT_EQ(client.next_message(5s)["id"], id);
}

TEST(ServerTest, OneClientTooManyGetsAnErrorAndTheOthersLive) {
  Config config;
  config.server.max_clients = 1;
  TestDaemon daemon(config);
  Client first(daemon.address());
  try {
    Client second(daemon.address());
    FAIL() << "a second client was served";
  } catch (const ClientError& error) {
    EXPECT_THAT(error.what(), HasSubstr("server.max_clients"));
  }
  EXPECT_NO_THROW(first.call("get_pose"));
}

TEST(ServerTest, AClientThatReadsNothingIsDisconnectedAndSlowsNobody) {
  Config config;
  config.server.outbox_bytes = 1 << 16;
  config.server.max_requests_per_s = 1e6;
  TestDaemon daemon(config);
  Client slow(daemon.address());
  std::string requests;
  for (int i = 0; i < 1000; ++i) requests += "{\"id\":1,\"method\":\"get_config\"}\n";
  try {
    // The replies are 100 MB and more, far beyond what the kernel's buffers take.
    for (int i = 0; i < 100; ++i) slow.send_raw(requests);
  } catch (const ClientError&) {
    // Already disconnected.
  }
  EXPECT_TRUE(daemon.wait_for("get_status", [](const Json& s) {
    return s["clients"] == 1 && s["server"]["slow_clients"] == 1;
  })) << "only the asking client is left";
}

TEST(ServerTest, AnIdleClientIsClosedAndASubscribedOneIsNot) {
  Config config;
  config.server.idle_timeout_s = 0.3;
  TestDaemon daemon(config);
  Client idle(daemon.address());
  Client subscribed(daemon.address());
  subscribed.call("subscribe", {{"topics", {"pose"}}});
  EXPECT_THROW(idle.next_message(5s), ClientError);
  EXPECT_EQ(subscribed.call("get_status")["server"]["idle_clients"], 1);
}

TEST(ServerTest, APortInUseIsASentenceThatNamesTheKey) {
  TestDaemon daemon;
  boost::asio::io_context io;
  Config config;
  Api api(io, daemon.runtime(), config);
  config.server.listen = daemon.address();
  try {
    const Server server(io, api, config);
    FAIL() << "two servers on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(daemon.address()));
    EXPECT_THAT(error.what(), HasSubstr("server.listen"));
  }
}

TEST(ServerTest, AddressesThatAreNoneOrNotLoopbackAreConfigErrors) {
  TestDaemon daemon;
  boost::asio::io_context io;
  for (const char* address : {"7788", "127.0.0.1:99999", "0.0.0.0:7788", "::1:7788"}) {
    Config config;
    Api api(io, daemon.runtime(), config);
    config.server.listen = address;
    EXPECT_THROW(Server(io, api, config), ConfigError) << address;
  }
}

TEST(ServerTest, AUnixSocketIsServedAndAStaleOneReplaced) {
  const std::string path = testing::TempDir() + "glint_server_test.sock";
  {
    // Left behind by a process that died: bound, but nobody listens.
    boost::asio::io_context io;
    boost::asio::local::stream_protocol::acceptor dead(io);
    dead.open();
    std::filesystem::remove(path);
    dead.bind({path});
  }
  Config config;
  config.server.unix_socket = path;
  {
    TestDaemon daemon(config);
    Client client(path);
    EXPECT_EQ(client.call("get_pose")["state"], "INIT");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ServerTest, AFileThatIsNoSocketIsNeverRemoved) {
  const std::string path = testing::TempDir() + "glint_server_test.txt";
  std::ofstream(path) << "precious";
  Config config;
  config.server.unix_socket = path;
  EXPECT_THROW(TestDaemon{config}, std::runtime_error);
  EXPECT_TRUE(std::filesystem::exists(path));
}

class SubscriptionsTest : public testing::Test {
 protected:
  /// A snapshot of scan k, 10 Hz.
  static std::shared_ptr<const Snapshot> scan(std::int64_t k) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->estimate.emplace();
    snapshot->estimate->stamp.ns = k * 100'000'000;
    return snapshot;
  }
  static Json params_of(const std::optional<std::string>& line) {
    return Json::parse(line.value())["params"];
  }

  boost::asio::io_context io_;
  TestDaemon daemon_;
  Api api_{io_, daemon_.runtime(), Config{}};
  ServerCounters counters_;
  Subscriptions subscriptions_{api_, counters_, [] {}};
};

TEST_F(SubscriptionsTest, ASlowClientMissesTheOldestAndIsToldHowMany) {
  subscriptions_.subscribe({{"topics", {"pose"}}});
  for (std::int64_t k = 0; k < 100; ++k) subscriptions_.offer(scan(k));
  const Json first = params_of(subscriptions_.next_line());
  EXPECT_EQ(first["seq"], 36);
  EXPECT_EQ(first["missed"], 36);
  Json last;
  while (const auto line = subscriptions_.next_line()) last = params_of(line);
  EXPECT_EQ(last["seq"], 99);
}

TEST_F(SubscriptionsTest, AllAreToldOnePoseEachInItsFrameWithItsNumber) {
  Subscriptions other(api_, counters_, [] {});
  Subscriptions elsewhere(api_, counters_, [] {});
  subscriptions_.subscribe({{"topics", {"pose"}}});
  subscriptions_.offer(scan(0));
  other.subscribe({{"topics", {"pose"}}});
  elsewhere.subscribe({{"topics", {"pose"}}, {"frame", "odom"}, {"child", "base"}});
  const auto newest = scan(1);
  for (Subscriptions* const each : {&subscriptions_, &other, &elsewhere}) each->offer(newest);
  static_cast<void>(subscriptions_.next_line());
  Json first = params_of(subscriptions_.next_line());
  Json second = params_of(other.next_line());
  const Json third = params_of(elsewhere.next_line());
  EXPECT_EQ(first["seq"], 1);
  EXPECT_EQ(second["seq"], 0);
  second["seq"] = 1;
  EXPECT_EQ(first, second);
  EXPECT_EQ(third["frame"], "odom");
  EXPECT_EQ(third["child"], "base");
  EXPECT_EQ(third["t_ns"], 100'000'000);
}

TEST_F(SubscriptionsTest, ALowerRateThinsEvenly) {
  subscriptions_.subscribe({{"topics", {"pose"}}, {"rate_hz", 2.0}});
  for (std::int64_t k = 0; k < 20; ++k) subscriptions_.offer(scan(k));
  std::vector<std::int64_t> stamps;
  while (const auto line = subscriptions_.next_line()) {
    stamps.push_back(params_of(line)["t_ns"].get<std::int64_t>() / 100'000'000);
  }
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{0, 5, 10, 15}));
}

TEST_F(SubscriptionsTest, ARateAboveTheSensorsIsToldAsTheSensors) {
  const Json echo = subscriptions_.subscribe({{"topics", {"pose"}}, {"rate_hz", 100}});
  EXPECT_EQ(echo["settings"]["pose"]["rate_hz"], 10.0);
  EXPECT_EQ(echo["settings"]["pose"]["every_scan"], true);
}

TEST_F(SubscriptionsTest, UnknownTopicsAreRefused) {
  EXPECT_THROW(subscriptions_.subscribe({{"topics", {"images"}}}), RpcError);
  EXPECT_THROW(subscriptions_.subscribe({{"topics", Json::array()}}), RpcError);
  EXPECT_TRUE(subscriptions_.empty());
}

}  // namespace
}  // namespace glint::daemon
