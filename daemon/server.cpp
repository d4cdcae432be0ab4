// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/server.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

#include "daemon/listener.hpp"
#include "daemon/passed_sockets.hpp"
#include "daemon/steady_clock.hpp"

namespace glint::daemon {
namespace {

using boost::asio::ip::tcp;
using boost::asio::local::stream_protocol;
using boost::system::error_code;

constexpr const char* kListenKey = "server.listen";
constexpr std::chrono::milliseconds kTick{100};
constexpr std::chrono::seconds kAcceptPause{1};
/// Poses on their way to the main thread; more only when it hangs.
constexpr int kMaxPosted = 256;

SessionLimits limits_of(const Config::Server& server) {
  return {static_cast<std::size_t>(server.outbox_bytes),
          static_cast<std::int64_t>(server.idle_timeout_s * 1e9),
          static_cast<std::int64_t>(server.stall_timeout_s * 1e9), server.max_requests_per_s};
}

/// A socket file whose owner is gone stays behind and must go; one that answers is in use.
void remove_stale_socket(boost::asio::io_context& io, const std::string& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode)) return;
  stream_protocol::socket probe(io);
  error_code error;
  probe.connect(stream_protocol::endpoint(path), error);
  if (!error) {
    throw std::runtime_error(fmt::format(
        "the socket {} is served by another program; stop it or change server.unix_socket", path));
  }
  ::unlink(path.c_str());
}

}  // namespace

Server::Server(boost::asio::io_context& io, Api& api, const Config& config)
    : io_(io),
      api_(api),
      max_clients_(static_cast<std::size_t>(config.server.max_clients)),
      access_(config.server),
      tls_(make_tls_context(config.server)),
      context_{api, access_, limits_of(config.server), counters_},
      tcp_(io),
      unix_(io),
      timer_(io) {
  const PassedSockets passed = take_passed_sockets();
  if (passed.tcp >= 0) {
    adopt_tcp(passed.tcp);
  } else if (!config.server.listen.empty()) {
    listen_tcp(config.server.listen);
  }
  const std::string path =
      resolve_auto(config.server.unix_socket, "RUNTIME_DIRECTORY", "glintd.sock");
  if (passed.unix_stream >= 0) {
    adopt_unix(passed.unix_stream);
  } else if (!path.empty()) {
    listen_unix(path);
  }
  if (!tcp_.is_open() && !unix_.is_open()) {
    throw ConfigError("server.listen and server.unix_socket are both empty: nobody could connect");
  }
  api_.set_server_counters(counters_);
}

Server::~Server() {
  try {
    close();
  } catch (const std::exception&) {
    // The sockets close with their objects.
  }
}

void Server::listen_tcp(const std::string& address) {
  const tcp::endpoint endpoint = resolve_listen(io_, address, kListenKey);
  guard_tcp(endpoint, fmt::format("{} = \"{}\"", kListenKey, address));
  listen_at(tcp_, endpoint, kListenKey);
}

void Server::adopt_tcp(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  tcp_.assign(address.ss_family == AF_INET6 ? tcp::v6() : tcp::v4(), fd);
  std::ostringstream name;
  name << "ListenStream=" << tcp_.local_endpoint();
  guard_tcp(tcp_.local_endpoint(), name.str());
}

// Who reaches the sensor's poses from elsewhere has a token.
void Server::guard_tcp(const tcp::endpoint& endpoint, const std::string& name) {
  const bool is_local = endpoint.address().is_loopback();
  if (!is_local && !access_.has_tokens()) {
    throw ConfigError(fmt::format(
        "{} can be reached by other machines, which needs a token: name a file "
        "with one in server.read_token_file or server.control_token_file, or listen on 127.0.0.1 "
        "and reach it through an SSH tunnel",
        name));
  }
  if (!is_local && !tls_) {
    spdlog::warn(
        "{}: tokens and poses cross the network in the clear; set "
        "server.tls_certificate_file and server.tls_key_file",
        name);
  }
  tcp_asks_token_ = !is_local || access_.is_required();
}

void Server::listen_unix(const std::string& path) {
  if (path.size() >= 108) {
    throw ConfigError(fmt::format("server.unix_socket: {} is longer than 107 bytes", path));
  }
  remove_stale_socket(io_, path);
  unix_.open();
  error_code error;
  const mode_t old_mask = ::umask(0117);  // Owner and group may connect.
  unix_.bind(stream_protocol::endpoint(path), error);
  ::umask(old_mask);
  if (!error) unix_.listen(boost::asio::socket_base::max_listen_connections, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("cannot listen on {}: {}; change server.unix_socket", path, error.message()));
  }
  unix_path_ = path;
  unlinks_unix_ = true;
}

void Server::adopt_unix(int fd) {
  unix_.assign(stream_protocol(), fd);
  unix_path_ = unix_.local_endpoint().path();
}

void Server::start() {
  if (tcp_.is_open()) accept(tcp_);
  if (unix_.is_open()) accept(unix_);
  tick();
}

template <class Acceptor>
void Server::accept(Acceptor& acceptor) {
  acceptor.async_accept([this, &acceptor](error_code error, auto socket) {
    if (closed_) return;
    if (!error) {
      constexpr bool kIsTcp = std::is_same_v<Acceptor, tcp::acceptor>;
      if constexpr (kIsTcp) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
      }
      admit(Connection::Socket(std::move(socket)), kIsTcp);
    }
    if (!error) return accept(acceptor);
    // Out of file descriptors or the like: it passes, and a retry at once would spin.
    ++counters_.failed_accepts;
    auto pause = std::make_shared<boost::asio::steady_timer>(io_, kAcceptPause);
    pause->async_wait([this, &acceptor, pause](error_code) {
      if (!closed_) accept(acceptor);
    });
  });
}

// Who has no token must not keep out those who have one.
std::size_t Server::most_without_token() const {
  return std::max<std::size_t>(1, max_clients_ / 2);
}

void Server::refuse(Connection::Socket socket, const std::string& why) {
  ++counters_.refused_clients;
  // A fresh connection's buffer takes one line; if not, the client sees just the close.
  error_code ignored;
  socket.non_blocking(true, ignored);
  socket.send(boost::asio::buffer(error_line(nullptr, RpcError(kBusy, why))), 0, ignored);
}

void Server::admit(Connection::Socket socket, bool is_tcp) {
  if (sessions_.size() >= max_clients_) {
    return refuse(std::move(socket), fmt::format("{} clients are connected already, which is the "
                                                 "most allowed (server.max_clients)",
                                                 sessions_.size()));
  }
  const bool asks_token = is_tcp ? tcp_asks_token_ : access_.is_required();
  const auto without_token = static_cast<std::size_t>(
      std::ranges::count_if(sessions_, [](const auto& session) { return session->owes_token(); }));
  if (asks_token && without_token >= most_without_token()) {
    return refuse(std::move(socket),
                  "too many clients have not sent a token yet; try again in ten seconds");
  }
  auto session =
      std::make_shared<Session>(is_tcp && tls_ ? make_tls_connection(std::move(socket), *tls_)
                                               : make_plain_connection(std::move(socket)),
                                context_, asks_token ? Right::kNone : Right::kControl,
                                [this](const std::shared_ptr<Session>& closed) {
                                  sessions_.erase(closed);
                                  api_.set_client_count(sessions_.size());
                                });
  sessions_.insert(session);
  ++counters_.accepted_clients;
  api_.set_client_count(sessions_.size());
  session->start();
}

void Server::read_secrets_again(const Config::Server& config) {
  Access access(config);
  // Connections hold what they need of the former one.
  tls_ = make_tls_context(config);
  if (access == access_) return;
  access_ = std::move(access);
  const std::vector<std::shared_ptr<Session>> sessions(sessions_.begin(), sessions_.end());
  for (const auto& session : sessions) {
    if (session->lives_by_token()) session->close();
  }
}

void Server::tick() {
  counters_.unsent_poses = unsent_poses_.load();
  const std::vector<std::shared_ptr<Session>> sessions(sessions_.begin(), sessions_.end());
  for (const auto& session : sessions) session->tick(steady_now_ns());
  timer_.expires_after(kTick);
  timer_.async_wait([this](error_code error) {
    if (!error && !closed_) tick();
  });
}

void Server::publish(const std::shared_ptr<const Snapshot>& snapshot) {
  if (poses_posted_.fetch_add(1) >= kMaxPosted) {
    poses_posted_.fetch_sub(1);
    unsent_poses_.fetch_add(1);
    return;
  }
  boost::asio::post(io_, [this, snapshot] {
    poses_posted_.fetch_sub(1);
    const std::vector<std::shared_ptr<Session>> sessions(sessions_.begin(), sessions_.end());
    for (const auto& session : sessions) session->offer(snapshot);
  });
}

void Server::close() {
  if (std::exchange(closed_, true)) return;
  error_code ignored;
  tcp_.close(ignored);
  unix_.close(ignored);
  if (unlinks_unix_) ::unlink(unix_path_.c_str());
  timer_.cancel();
  const std::vector<std::shared_ptr<Session>> sessions(sessions_.begin(), sessions_.end());
  for (const auto& session : sessions) session->close();
}

std::uint16_t Server::tcp_port() const {
  error_code error;
  const auto endpoint = tcp_.local_endpoint(error);
  return error ? std::uint16_t{0} : endpoint.port();
}

std::string resolve_auto(const std::string& value, const char* variable, const std::string& file) {
  if (value != "auto") return value;
  const char* directories = std::getenv(variable);
  if (directories == nullptr || *directories == '\0') return {};
  const std::string list = directories;
  std::string path = list.substr(0, list.find(':'));
  if (!file.empty()) path += "/" + file;
  return path;
}

}  // namespace glint::daemon
