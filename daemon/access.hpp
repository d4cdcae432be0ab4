// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config.hpp"

namespace glint::daemon {

/// What a client may do; each one includes those before it.
enum class Right : std::uint8_t { kNone, kRead, kControl };

/// What a method asks for. What is not known to only tell needs kControl.
Right needed_right(std::string_view method);

/// "none", "read", "control".
std::string_view to_string(Right right);

/// The tokens that give rights to clients. They come from files, for the configuration may be read
/// by anyone. Only their digests are kept. Const calls are thread-safe.
class Access {
 public:
  /// Reads the files of server.read_token_file and server.control_token_file, a token a line, and
  /// warns of one that others may read. @throws ConfigError when one cannot be read, holds no token
  /// or one that could be guessed, or when tokens are required and there are none.
  explicit Access(const Config::Server& server);

  [[nodiscard]] bool has_tokens() const { return !tokens_.empty(); }
  /// Whether clients of this machine need one, too.
  [[nodiscard]] bool is_required() const { return required_; }
  /// What a token gives, in a time that does not tell how much of it is right.
  [[nodiscard]] Right right_of(std::string_view token) const;
  /// The same tokens with the same rights.
  bool operator==(const Access&) const = default;

 private:
  using Digest = std::array<unsigned char, 32>;
  struct Token {
    Digest digest;
    Right right;
    bool operator==(const Token&) const = default;
  };
  static Digest digest_of(std::string_view token);
  void read_tokens(const std::string& file, const char* key, Right right);

  bool required_;
  std::vector<Token> tokens_;
};

/// Where a file with a secret is: a relative name is one of systemd's credentials of this service.
/// @throws ConfigError naming `key` when there are none.
std::string secret_path(const std::string& file, const char* key);

}  // namespace glint::daemon
