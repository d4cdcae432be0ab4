// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <chrono>
#include <memory>
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

class ClientTls;

/// What a daemon may ask of a client.
struct ClientSecurity {
  std::string tls_ca_file;  ///< PEM, vouches for the daemon's certificate; empty: without TLS.
  std::string token;        ///< Sent where one is asked; empty: none.
};

/// A blocking connection to glintd. Thread-compatible.
class Client {
 public:
  /// `target`: HOST:PORT, or the path of a Unix socket (anything with a slash), which never has
  /// TLS. Waits for hello, and authenticates where that is asked.
  /// @throws ClientError with a sentence that names the target and what to do.
  explicit Client(const std::string& target, const ClientSecurity& security = {});
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
  void shake_hands(const ClientSecurity& security);
  void take_hello();
  void authenticate(const std::string& token);
  void connect_unix(const std::string& path);
  std::ptrdiff_t receive(char* buffer, std::size_t size);
  std::string read_line(std::optional<std::chrono::milliseconds> timeout);

  const std::string target_;
  int socket_ = -1;
  std::unique_ptr<ClientTls> tls_;  ///< Null without TLS.
  std::string input_;
  Json hello_;
  std::int64_t next_id_ = 1;
};

}  // namespace glint::daemon
