// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <set>
#include <string>

#include "daemon/log.hpp"
#include "daemon/runtime.hpp"
#include "daemon/sensor_settings.hpp"
#include "driver/session/network_client.hpp"
#include "driver/session/sensor_session.hpp"
#include "driver/session/session_runner.hpp"

namespace glint::daemon {

/// The session with a live sensor, and what follows of it: the runtime is told the sensor's
/// metadata and address, the log and the clients each change of state. Begins at once and never
/// gives up. Thread-compatible: lives on the thread that runs the io_context.
class SensorLink {
 public:
  /// `runtime` must outlive it. @throws InputError for settings that no sensor takes.
  SensorLink(boost::asio::io_context& io, Runtime& runtime, const SensorLinkOptions& options);

  [[nodiscard]] const SessionStatus& status() const { return session_.status(); }
  /// Why nothing comes of the sensor although the session is well, as one sentence; else empty.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  void on_news(SessionState state, const std::string& sentence);
  bool is_worth_a_line(SessionState state, const std::string& sentence);
  void on_metadata(const std::string& json);
  [[nodiscard]] std::string mismatch(const SensorInfo& info) const;
  void use(const SensorInfo& info);
  void filter_source();
  void tell(const std::string& sentence);
  [[nodiscard]] PacketActivity activity() const;

  Runtime& runtime_;
  const SensorLinkOptions options_;
  LogLimiter limiter_;
  std::set<std::string> told_;  ///< News since packets arrived last.
  std::string problem_;
  std::string filtered_address_;
  NetworkSensorClient client_;
  SensorSession session_;
  SessionRunner runner_;
};

}  // namespace glint::daemon
