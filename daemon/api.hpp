// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>

#include "daemon/config.hpp"
#include "daemon/protocol.hpp"
#include "daemon/protocol_pose.hpp"
#include "daemon/protocol_status.hpp"
#include "daemon/runtime.hpp"

namespace glint::daemon {

class SensorLink;

/// The methods that any client may call and that concern no one else: requests in, lines out.
/// Lives on the main thread; map queries run on the worker and come back by the io_context.
class Api {
 public:
  /// Takes the line that answers a request. Called once, at once or later, on the main thread.
  using Reply = std::function<void(std::string line)>;

  Api(boost::asio::io_context& io, Runtime& runtime, const Config& config);

  /// Answers a request that has an id. @throws RpcError, then there is no other reply.
  void call(const Request& request, Reply reply);

  /// The first line of a connection.
  [[nodiscard]] std::string hello_line() const;
  [[nodiscard]] Json status() const;
  [[nodiscard]] Json pose(const Snapshot& snapshot, PoseFrames frames) const;
  /// sensor, state and time: what every answer has.
  [[nodiscard]] Json head() const;
  [[nodiscard]] const EventLog& events() const { return runtime_.events(); }
  [[nodiscard]] double scan_rate_hz() const { return runtime_.scan_rate_hz(); }
  /// The session with the sensor, for status; must outlive the calls.
  void set_sensor(const SensorLink& sensor) { sensor_ = &sensor; }
  /// Clients connected now, for status.
  void set_client_count(std::size_t count) { client_count_ = count; }

 private:
  using Method = Json (Api::*)(const Json& params);
  static Method find_method(std::string_view name);

  Json call_get_pose(const Json& params);
  Json call_get_status(const Json& params);
  Json call_get_trajectory(const Json& params);
  Json call_get_config(const Json& params);
  Json call_pause(const Json& params);
  Json call_resume(const Json& params);
  Json call_reset_odometry(const Json& params);
  void call_get_map(const Request& request, Reply reply);
  Json post_command(Command command);
  [[nodiscard]] PoseContext context() const;

  boost::asio::io_context& io_;
  Runtime& runtime_;
  const Config config_;
  const SensorLink* sensor_ = nullptr;  ///< Null: there is no session with the sensor.
  const std::string instance_;
  const std::int64_t start_ns_;
  std::size_t client_count_ = 0;
};

}  // namespace glint::daemon
