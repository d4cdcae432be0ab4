// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Sockets that systemd opened for glintd. GLINTD names the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <future>

#include "daemon/test_glintd.hpp"

namespace glint::daemon {
namespace {

using boost::asio::ip::tcp;
using boost::asio::local::stream_protocol;
using testing::HasSubstr;

class PassedSocketsTest : public GlintdTest {
 protected:
  tcp::acceptor listen_tcp(const std::string& address) {
    return {io_, tcp::endpoint(boost::asio::ip::make_address(address), 0)};
  }
  stream_protocol::acceptor listen_unix() {
    return {io_, stream_protocol::endpoint((directory_ / "passed.sock").string())};
  }
  static std::string address_of(const tcp::acceptor& acceptor) {
    return "127.0.0.1:" + std::to_string(acceptor.local_endpoint().port());
  }
  /// Arguments of a daemon that serves a capture, with `more` settings.
  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) {
    auto all = serve_capture(1);
    for (const std::string& setting : more) all.insert(all.end(), {"--set", setting});
    return all;
  }
  bool answers(const std::string& address) {
    return !poll_status([](const Json&) { return true; }, address).is_null();
  }

  boost::asio::io_context io_;
};

TEST_F(PassedSocketsTest, AUnixSocketIsServedAndItsFileStays) {
  auto passed = listen_unix();
  Process process(arguments(), directory_, {passed.native_handle()});
  EXPECT_TRUE(answers((directory_ / "passed.sock").string())) << process.log();
  EXPECT_FALSE(std::filesystem::exists(socket())) << "it takes the place of the configured one";
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 0);
  EXPECT_TRUE(std::filesystem::exists(directory_ / "passed.sock")) << "it is systemd's";
}

TEST_F(PassedSocketsTest, WhoConnectedBeforeTheStartIsAnswered) {
  auto passed = listen_unix();
  // A client waits for the greeting as long as its time-out, which is longer than a start.
  auto early = std::async(std::launch::async, [this] {
    return Client((directory_ / "passed.sock").string()).call("get_status");
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Process process(arguments(), directory_, {passed.native_handle()});
  EXPECT_TRUE(early.get().contains("state")) << process.log();
}

TEST_F(PassedSocketsTest, TcpTakesThePlaceOfListenAndLeavesTheUnixSocket) {
  auto taken = listen_tcp("127.0.0.1");
  auto passed = listen_tcp("127.0.0.1");
  const Process process(arguments({"server.listen=" + address_of(taken)}), directory_,
                        {passed.native_handle()});
  EXPECT_TRUE(answers(address_of(passed))) << process.log();
  EXPECT_TRUE(answers(socket()));
}

TEST_F(PassedSocketsTest, BothKindsAtOnce) {
  auto tcp = listen_tcp("127.0.0.1");
  auto unix_stream = listen_unix();
  const Process process(arguments(), directory_,
                        {tcp.native_handle(), unix_stream.native_handle()});
  EXPECT_TRUE(answers(address_of(tcp))) << process.log();
  EXPECT_TRUE(answers((directory_ / "passed.sock").string()));
}

TEST_F(PassedSocketsTest, AnAddressOtherMachinesReachNeedsAToken) {
  auto passed = listen_tcp("0.0.0.0");
  Process process(arguments(), directory_, {passed.native_handle()});
  EXPECT_EQ(process.wait(), 78);
  EXPECT_THAT(process.log(), HasSubstr("ListenStream=0.0.0.0:"));
  EXPECT_THAT(process.log(), HasSubstr("server.read_token_file"));
}

TEST_F(PassedSocketsTest, WhatCannotBeServedIsNamed) {
  boost::asio::ip::udp::socket datagrams(
      io_, boost::asio::ip::udp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  Process process(arguments(), directory_, {datagrams.native_handle()});
  EXPECT_EQ(process.wait(), 78);
  EXPECT_THAT(process.log(), HasSubstr("ListenStream"));
}

TEST_F(PassedSocketsTest, TwoOfAKindAreRefused) {
  auto first = listen_tcp("127.0.0.1");
  auto second = listen_tcp("127.0.0.1");
  Process process(arguments(), directory_, {first.native_handle(), second.native_handle()});
  EXPECT_EQ(process.wait(), 78);
  EXPECT_THAT(process.log(), HasSubstr("two sockets of one kind"));
}

}  // namespace
}  // namespace glint::daemon
