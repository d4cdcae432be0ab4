// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Tokens, and what they let a client do.
#include "daemon/access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using test::TestDaemon;
using testing::HasSubstr;
using namespace std::chrono_literals;

const std::string kReadToken = "read-0123456789abcdef";
const std::string kControlToken = "control-0123456789abcdef";

class AccessTest : public testing::Test {
 protected:
  AccessTest()
      : directory_(std::filesystem::path(testing::TempDir()) /
                   ("access_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
    config_.server.read_token_file = write("read", kReadToken + "\n");
    config_.server.control_token_file = write("control", "\n  " + kControlToken + " \n");
    config_.server.require_token = true;
  }
  ~AccessTest() override {
    unsetenv("CREDENTIALS_DIRECTORY");
    std::filesystem::remove_all(directory_);
  }
  std::string write(const std::string& name, const std::string& text) {
    const auto file = directory_ / name;
    std::ofstream(file) << text;
    return file;
  }
  static std::string error_of(const Config& config) {
    try {
      const Access access(config.server);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  static Json authenticate(Client& client, const std::string& token) {
    return client.call("authenticate", {{"token", token}});
  }
  /// data.code of the error that a call ends with; empty when it does not.
  static std::string refusal(Client& client, const char* method,
                             const Json& params = Json::object()) {
    try {
      client.call(method, params);
    } catch (const ReplyError& error) {
      return error.error()["data"].value("code", "?");
    }
    return "";
  }

  const std::filesystem::path directory_;
  Config config_;
};

TEST_F(AccessTest, TokensGiveTheRightsOfTheirFile) {
  const Access access(config_.server);
  EXPECT_EQ(access.right_of(kReadToken), Right::kRead);
  EXPECT_EQ(access.right_of(kControlToken), Right::kControl);
  EXPECT_EQ(access.right_of(kControlToken + "x"), Right::kNone);
  EXPECT_EQ(access.right_of(""), Right::kNone);
}

TEST_F(AccessTest, WhatIsNotKnownToOnlyTellNeedsControl) {
  for (const char* method : {"get_pose", "get_map", "list_maps", "subscribe", "unsubscribe"}) {
    EXPECT_EQ(needed_right(method), Right::kRead) << method;
  }
  for (const char* method : {"pause", "resume", "reset_odometry", "save_map", "load_map",
                             "clear_map", "delete_map", "relocalize", "set_initial_pose", "fly"}) {
    EXPECT_EQ(needed_right(method), Right::kControl) << method;
  }
}

TEST_F(AccessTest, FilesThatGiveNoTokenAreErrorsWithAWayOut) {
  Config config = config_;
  config.server.read_token_file = directory_ / "none";
  EXPECT_THAT(error_of(config), HasSubstr("No such file"));
  config.server.read_token_file = write("empty", "\n \n");
  EXPECT_THAT(error_of(config), HasSubstr("openssl rand -hex 32"));
  config.server.read_token_file = write("short", "secret\n");
  EXPECT_THAT(error_of(config), HasSubstr("server.read_token_file"));
  EXPECT_THAT(error_of(config), testing::Not(HasSubstr("secret")));
  config.server.read_token_file = config.server.control_token_file = "";
  EXPECT_THAT(error_of(config), HasSubstr("server.require_token"));
}

TEST_F(AccessTest, ARelativeNameIsACredentialOfTheService) {
  config_.server.read_token_file = "read";
  EXPECT_THAT(error_of(config_), HasSubstr("LoadCredential=read:"));
  setenv("CREDENTIALS_DIRECTORY", directory_.c_str(), 1);
  EXPECT_EQ(error_of(config_), "");
}

TEST_F(AccessTest, AnAddressThatOthersReachNeedsAToken) {
  TestDaemon daemon;
  boost::asio::io_context io;
  Config config;
  Api api(io, daemon.runtime(), config);
  config.server.listen = "0.0.0.0:0";
  try {
    const Server server(io, api, config);
    FAIL() << "served without a token";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("server.read_token_file"));
  }
  config.server.read_token_file = config_.server.read_token_file;
  EXPECT_NO_THROW(Server(io, api, config));
}

TEST_F(AccessTest, WithoutATokenOnlyAuthenticateIsAnswered) {
  TestDaemon daemon(config_);
  Client client(daemon.address());
  EXPECT_EQ(client.hello()["authentication"], "token");
  for (const char* method : {"get_pose", "subscribe", "pause", "fly"}) {
    EXPECT_EQ(refusal(client, method), "FORBIDDEN") << method;
  }
  EXPECT_EQ(authenticate(client, kReadToken)["rights"], Json({"read"}));
  EXPECT_EQ(client.call("get_status")["server"]["forbidden_requests"], 4);
}

TEST_F(AccessTest, ReadingIsNotControl) {
  TestDaemon daemon(config_);
  Client client(daemon.address());
  authenticate(client, kReadToken);
  EXPECT_EQ(refusal(client, "get_pose"), "");
  EXPECT_EQ(refusal(client, "pause"), "FORBIDDEN");
  EXPECT_EQ(client.call("get_pose")["state"], "INIT");
  EXPECT_EQ(authenticate(client, kControlToken)["rights"], Json({"read", "control"}));
  EXPECT_EQ(refusal(client, "pause"), "");
}

TEST_F(AccessTest, WrongTokensAreAnsweredLateAndThreeOfThemEndTheConnection) {
  TestDaemon daemon(config_);
  Client client(daemon.address());
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(refusal(client, "authenticate", {{"token", "wrong-0123456789abcdef"}}), "FORBIDDEN");
  }
  EXPECT_GT(std::chrono::steady_clock::now() - begin, 3s);
  EXPECT_THROW(client.next_message(5s), ClientError);
  Client good(daemon.address());
  authenticate(good, kReadToken);
  EXPECT_EQ(good.call("get_status")["server"]["failed_authentications"], 3);
}

TEST_F(AccessTest, TheReadTokenDoesNotHelpToGuessTheOtherOne) {
  TestDaemon daemon(config_);
  Client client(daemon.address());
  authenticate(client, kReadToken);
  EXPECT_EQ(refusal(client, "authenticate", {{"token", "wrong-0123456789abcdef"}}), "FORBIDDEN");
}

TEST_F(AccessTest, WithoutATokenLinesAreShort) {
  TestDaemon daemon(config_);
  Client client(daemon.address());
  client.send_raw("{\"x\":\"" + std::string(10'000, 'x'));
  EXPECT_EQ(client.next_message(5s)["error"]["data"]["code"], "TOO_LARGE");
  EXPECT_THROW(client.next_message(5s), ClientError);
}

TEST_F(AccessTest, ThoseWithoutATokenLeaveRoomForThoseWithOne) {
  config_.server.max_clients = 2;
  TestDaemon daemon(config_);
  Client first(daemon.address());
  EXPECT_THROW(Client(daemon.address()), ClientError);
  authenticate(first, kReadToken);
  EXPECT_NO_THROW(Client(daemon.address()));
}

TEST_F(AccessTest, WhereNoneIsAskedAnyTokenWillDo) {
  TestDaemon daemon;
  Client client(daemon.address());
  EXPECT_EQ(client.hello()["authentication"], "none");
  EXPECT_EQ(authenticate(client, "whatever")["rights"], Json({"read", "control"}));
}

}  // namespace
}  // namespace glint::daemon
