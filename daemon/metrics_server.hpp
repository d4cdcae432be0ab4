// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "daemon/access.hpp"
#include "daemon/api.hpp"
#include "daemon/server_counters.hpp"

namespace glint::daemon {

/// HTTP for those who watch the daemon: /metrics for Prometheus, /healthz (its threads live) and
/// /readyz (it has a pose that can be used). One request a connection. Lives on the main thread.
class MetricsServer {
 public:
  /// Listens at metrics.listen from here on. What it refuses goes to `counters`. @throws
  /// ConfigError for an address that cannot be used, or that others reach without a token;
  /// std::runtime_error when it is taken.
  MetricsServer(boost::asio::io_context& io, const Api& api, const Access& access,
                ServerCounters& counters, const std::string& listen);

  void start() { accept(); }
  void close();
  [[nodiscard]] std::uint16_t port() const;

 private:
  class Exchange;
  void accept();

  const Api& api_;
  const Access& access_;
  ServerCounters& counters_;
  bool asks_token_ = false;
  int open_ = 0;  ///< Connections now.
  boost::asio::ip::tcp::acceptor acceptor_;
};

}  // namespace glint::daemon
