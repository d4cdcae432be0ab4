// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/access.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace glint::daemon {
namespace {

/// Shorter tokens could be found by trying.
constexpr std::size_t kLeastTokenSize = 16;
/// Methods that only tell. get_... do, too.
constexpr std::array<std::string_view, 3> kTellingMethods = {"list_maps", "subscribe",
                                                             "unsubscribe"};

void warn_if_others_may_read(const std::string& path, const char* key) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || (info.st_mode & S_IROTH) == 0) return;
  spdlog::warn("{}: {} can be read by every user of this machine; chmod o-r {}", key, path, path);
}

std::string trimmed(const std::string& line) {
  const auto begin = line.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return line.substr(begin, line.find_last_not_of(" \t\r") - begin + 1);
}

}  // namespace

Right needed_right(std::string_view method) {
  const bool tells = method.starts_with("get_") ||
                     std::ranges::find(kTellingMethods, method) != kTellingMethods.end();
  return tells ? Right::kRead : Right::kControl;
}

std::string_view to_string(Right right) {
  constexpr std::array<std::string_view, 3> kNames = {"none", "read", "control"};
  return kNames[static_cast<std::size_t>(right)];
}

std::string secret_path(const std::string& file, const char* key) {
  if (file.starts_with('/')) return file;
  const char* directory = std::getenv("CREDENTIALS_DIRECTORY");
  if (directory != nullptr && *directory != '\0') return fmt::format("{}/{}", directory, file);
  throw ConfigError(fmt::format(
      "{} = \"{}\" is the name of a systemd credential, and this service has none; give the whole "
      "path, or add LoadCredential={}:/PATH to the unit",
      key, file, file));
}

Access::Access(const Config::Server& server) : required_(server.require_token) {
  read_tokens(server.read_token_file, "server.read_token_file", Right::kRead);
  read_tokens(server.control_token_file, "server.control_token_file", Right::kControl);
  if (required_ && tokens_.empty()) {
    throw ConfigError(
        "server.require_token is true, and there is no token; name a file with one in "
        "server.read_token_file or server.control_token_file");
  }
}

void Access::read_tokens(const std::string& file, const char* key, Right right) {
  if (file.empty()) return;
  const std::string path = secret_path(file, key);
  std::ifstream in(path);
  if (!in) {
    throw ConfigError(fmt::format("{}: {} cannot be read: {}", key, path, std::strerror(errno)));
  }
  warn_if_others_may_read(path, key);
  const std::size_t known_before = tokens_.size();
  int line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    const std::string token = trimmed(line);
    if (token.empty()) continue;
    if (token.size() < kLeastTokenSize) {
      throw ConfigError(fmt::format(
          "{}: line {} of {} has {} characters, a token at least {}; make one with: openssl rand "
          "-hex 32",
          key, line_number, path, token.size(), kLeastTokenSize));
    }
    tokens_.push_back({digest_of(token), right});
  }
  if (tokens_.size() == known_before) {
    throw ConfigError(
        fmt::format("{}: {} holds no token; make one with: openssl rand -hex 32", key, path));
  }
}

Access::Digest Access::digest_of(std::string_view token) {
  Digest digest{};
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), digest.data());
  return digest;
}

Right Access::right_of(std::string_view token) const {
  const Digest digest = digest_of(token);
  Right right = Right::kNone;
  for (const Token& known : tokens_) {
    const bool same = CRYPTO_memcmp(digest.data(), known.digest.data(), digest.size()) == 0;
    if (same) right = std::max(right, known.right);
  }
  return right;
}

}  // namespace glint::daemon
