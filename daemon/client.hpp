// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>

#include "daemon/config.hpp"

namespace glint::daemon {

/// The daemon cannot be reached, went away, or does not speak this protocol.
class ClientError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The daemon answered with an error; what() is its sentence.
class ReplyError : public std::runtime_error {
 public:
  explicit ReplyError(Json error)
      : std::runtime_error(error.value("message", "error without a message")),
        error_(std::move(error)) {}
  [[nodiscard]] const Json& error() const { return error_; }

 private:
  Json error_;
};

/// A blocking connection to glintd. Thread-compatible.
class Client {
 public:
  /// `target`: HOST:PORT, or the path of a Unix socket (anything with a slash). Waits for hello.
  /// @throws ClientError with a sentence that names the target and what to do.
  explicit Client(const std::string& target);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] const Json& hello() const { return hello_; }
  /// The `result` of a method. Notifications that arrive meanwhile are dropped.
  /// @throws ClientError, ReplyError.
  Json call(const std::string& method, const Json& params = Json::object());
  /// The next message, whatever it is. @throws ClientError when the daemon hangs up, or when
  /// nothing arrives within `timeout`.
  Json next_message(std::optional<std::chrono::milliseconds> timeout = std::nullopt);
  /// Sends bytes as they are, for tests.
  void send_raw(std::string_view bytes);

 private:
  void connect_tcp(const std::string& target);
  void connect_unix(const std::string& path);
  std::string read_line(std::optional<std::chrono::milliseconds> timeout);

  const std::string target_;
  int socket_ = -1;
  std::string input_;
  Json hello_;
  std::int64_t next_id_ = 1;
};

}  // namespace glint::daemon
