// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <optional>

#include "daemon/api.hpp"
#include "daemon/config.hpp"
#include "daemon/health_log.hpp"
#include "daemon/input.hpp"
#include "daemon/metrics_server.hpp"
#include "daemon/runtime.hpp"
#include "daemon/sensor_link.hpp"
#include "daemon/server.hpp"

namespace glint::daemon {

/// The daemon: pipeline, session with the sensor, server, signals and supervision, on the caller's
/// thread.
class Service {
 public:
  /// Reads the configuration again, for SIGHUP. @throws ConfigError.
  using Reload = std::function<Config()>;

  /// Listens from here on. `io` must outlive it. @throws as open_input(), Server and Runtime do.
  Service(boost::asio::io_context& io, const Config& config, Input input, Reload reload);

  /// Serves until SIGTERM, SIGINT or a fault. Returns the exit code: 0, or 1 after a fault.
  int run();

 private:
  void make_room_for_sessions();
  void wait_for_signal();
  void reload();
  void supervise();
  RuntimeStatus look_at_health();
  void stop(int exit_code);

  Config config_;
  const Reload reload_;
  boost::asio::io_context& io_;
  Runtime runtime_;
  std::optional<SensorLink> sensor_;  ///< Null without a session with the sensor.
  Api api_;
  Server server_;
  std::optional<MetricsServer> metrics_;  ///< Null without metrics.listen.
  boost::asio::signal_set signals_;
  boost::asio::steady_timer timer_;
  HealthLog health_;
  int exit_code_ = 0;
};

}  // namespace glint::daemon
