// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "daemon/api.hpp"
#include "daemon/session.hpp"
#include "daemon/tls_context.hpp"

namespace glint::daemon {

/// Listens on TCP and on a Unix socket and keeps the sessions. Lives on the main thread, but for
/// publish().
class Server {
 public:
  /// Listens from here on, on what systemd passed and else on what the configuration names. @throws
  /// ConfigError for an address that cannot be used, std::runtime_error with one sentence when it
  /// is taken.
  Server(boost::asio::io_context& io, Api& api, const Config& config);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Begins to accept.
  void start();
  /// Certificate, key and tokens are what their files hold now; `config` names the same files as
  /// before. Clients that were let in by a token come anew when tokens have changed. Main thread.
  /// @throws ConfigError when one cannot be used; then all stays as it was.
  void read_secrets_again(const Config::Server& config);
  /// Closes everything; afterwards the io_context has no work of the server.
  void close();
  /// Hands a new pose to the subscribers. From any thread; does not wait. When the main thread is
  /// far behind, the pose is left out, and counted.
  void publish(const std::shared_ptr<const Snapshot>& snapshot);

  /// Port of the TCP server; 0 if there is none.
  [[nodiscard]] std::uint16_t tcp_port() const;
  /// Path of the Unix socket; empty if there is none.
  [[nodiscard]] const std::string& unix_path() const { return unix_path_; }
  [[nodiscard]] const Access& access() const { return access_; }
  [[nodiscard]] ServerCounters& counters() { return counters_; }
  [[nodiscard]] std::size_t client_count() const { return sessions_.size(); }

 private:
  void listen_tcp(const std::string& address);
  void adopt_tcp(int fd);
  void guard_tcp(const boost::asio::ip::tcp::endpoint& endpoint, const std::string& name);
  void listen_unix(const std::string& path);
  void adopt_unix(int fd);
  template <class Acceptor>
  void accept(Acceptor& acceptor);
  void admit(Connection::Socket socket, bool is_tcp);
  void refuse(Connection::Socket socket, const std::string& why);
  [[nodiscard]] std::size_t most_without_token() const;
  void tick();

  boost::asio::io_context& io_;
  Api& api_;
  const std::size_t max_clients_;
  Access access_;
  std::unique_ptr<boost::asio::ssl::context> tls_;  ///< Null: TCP goes without.
  ServerCounters counters_;
  const SessionContext context_;
  bool tcp_asks_token_ = false;
  boost::asio::ip::tcp::acceptor tcp_;
  boost::asio::local::stream_protocol::acceptor unix_;
  std::string unix_path_;
  bool unlinks_unix_ = false;  ///< The socket's file is ours, not systemd's.
  boost::asio::steady_timer timer_;
  std::set<std::shared_ptr<Session>> sessions_;
  std::atomic<int> poses_posted_{0};
  std::atomic<std::uint64_t> unsent_poses_{0};
  bool closed_ = false;
};

/// What server.unix_socket and state.directory mean: "auto" is the place that systemd made for this
/// service (first entry of the variable), or nothing without systemd.
std::string resolve_auto(const std::string& value, const char* variable, const std::string& file);

}  // namespace glint::daemon
