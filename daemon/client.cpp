// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/client.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "daemon/client_tls.hpp"
#include "daemon/host_port.hpp"

namespace glint::daemon {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kReplyTimeout{10'000};

std::string cannot_reach(const std::string& target, const std::string& why) {
  return fmt::format(
      "cannot reach glintd at {}: {}; is it running? (--connect names another place)", target, why);
}

/// A send, a receive or a connect that hangs for so long fails with EAGAIN.
void limit_waits(int socket) {
  const timeval limit{kReplyTimeout.count() / 1000, 0};
  setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

}  // namespace

Client::Client(const std::string& target, const ClientSecurity& security) : target_(target) {
  const bool is_path = target.find('/') != std::string::npos;
  if (is_path) {
    connect_unix(target);
  } else {
    connect_tcp(target);
  }
  try {
    if (!is_path) shake_hands(security);
    take_hello();
    if (hello_.value("authentication", "none") == "token") authenticate(security.token);
  } catch (...) {
    ::close(socket_);
    throw;
  }
}

Client::~Client() { ::close(socket_); }

void Client::shake_hands(const ClientSecurity& security) {
  if (security.tls_ca_file.empty()) return;
  try {
    tls_ =
        std::make_unique<ClientTls>(socket_, security.tls_ca_file, parse_host_port(target_)->host);
  } catch (const std::runtime_error& error) {
    throw ClientError(fmt::format("no TLS with glintd at {}: {}", target_, error.what()));
  }
}

void Client::take_hello() {
  const Json message = next_message(kReplyTimeout);
  if (message.contains("error")) {
    throw ClientError(fmt::format("glintd at {} refuses the connection: {}", target_,
                                  message["error"].value("message", "")));
  }
  if (message.value("method", "") != "hello") {
    throw ClientError(cannot_reach(target_, "what answers there is no glintd"));
  }
  hello_ = message.at("params");
}

void Client::authenticate(const std::string& token) {
  if (token.empty()) return;
  try {
    call("authenticate", {{"token", token}});
  } catch (const ReplyError& error) {
    throw ClientError(fmt::format("glintd at {} refuses the token: {}", target_, error.what()));
  }
}

void Client::connect_tcp(const std::string& target) {
  const auto place = parse_host_port(target);
  if (!place) {
    throw ClientError(fmt::format("{} is neither HOST:PORT nor the path of a socket", target));
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  const int failure =
      getaddrinfo(place->host.c_str(), std::to_string(place->port).c_str(), &hints, &list);
  if (failure != 0) throw ClientError(cannot_reach(target, gai_strerror(failure)));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(list, &freeaddrinfo);
  std::string why = "no address";
  for (const addrinfo* a = list; a != nullptr; a = a->ai_next) {
    socket_ = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (socket_ < 0) continue;
    limit_waits(socket_);
    if (::connect(socket_, a->ai_addr, a->ai_addrlen) == 0) return;
    why = std::strerror(errno);
    ::close(socket_);
  }
  throw ClientError(cannot_reach(target, why));
}

void Client::connect_unix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw ClientError(fmt::format("{} is too long for the path of a socket", path));
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket_ >= 0) limit_waits(socket_);
  const void* generic = &address;
  if (socket_ < 0 ||
      ::connect(socket_, static_cast<const sockaddr*>(generic), sizeof address) != 0) {
    const std::string why = std::strerror(errno);
    ::close(socket_);
    throw ClientError(cannot_reach(path, why));
  }
}

void Client::send_raw(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent =
        tls_ ? tls_->send(bytes) : ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) {
      throw ClientError(fmt::format("glintd at {} went away: {}", target_, std::strerror(errno)));
    }
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

Json Client::call(const std::string& method, const Json& params) {
  const std::int64_t id = next_id_++;
  send_raw(Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump() +
           "\n");
  while (true) {
    Json message = next_message(kReplyTimeout);
    if (!message.contains("id") || message["id"] != id) continue;
    if (message.contains("error")) throw ReplyError(message["error"]);
    return message.at("result");
  }
}

Json Client::next_message(std::optional<milliseconds> timeout) {
  Json message = Json::parse(read_line(timeout), nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) {
    throw ClientError(fmt::format("what answers at {} speaks no JSON-RPC", target_));
  }
  return message;
}

std::ptrdiff_t Client::receive(char* buffer, std::size_t size) {
  return tls_ ? tls_->receive(buffer, size) : ::recv(socket_, buffer, size, 0);
}

std::string Client::read_line(std::optional<milliseconds> timeout) {
  std::size_t searched = 0;
  while (true) {
    const auto end = input_.find('\n', searched);
    if (end != std::string::npos) {
      std::string line = input_.substr(0, end);
      input_.erase(0, end + 1);
      return line;
    }
    searched = input_.size();
    pollfd waiting{socket_, POLLIN, 0};
    const int limit_ms = timeout ? static_cast<int>(timeout->count()) : -1;
    const int ready = tls_ && tls_->has_pending() ? 1 : ::poll(&waiting, 1, limit_ms);
    if (ready == 0) {
      throw ClientError(
          fmt::format("glintd at {} has not answered for {} ms", target_, timeout->count()));
    }
    std::array<char, 65536> chunk{};
    const ssize_t got = ready < 0 ? -1 : receive(chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      const bool may_want_tls = hello_.is_null() && !tls_;
      throw ClientError(fmt::format("glintd at {} closed the connection{}", target_,
                                    may_want_tls ? "; does it want TLS? (--tls-ca FILE)" : ""));
    }
    input_.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace glint::daemon
