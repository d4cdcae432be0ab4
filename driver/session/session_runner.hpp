// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>

#include "driver/core/clock.hpp"
#include "driver/session/sensor_session.hpp"

namespace glint {

/// Steps a session on an io_context, when something is due and when the sensor has answered.
/// Thread-compatible: used on the thread that runs the io_context, which is the session's too.
class SessionRunner {
 public:
  /// Begins at once. `session` must outlive the runner; `clock` is that of PacketActivity.
  SessionRunner(boost::asio::io_context& io, SensorSession& session, Clock clock);
  ~SessionRunner();
  SessionRunner(const SessionRunner&) = delete;
  SessionRunner& operator=(const SessionRunner&) = delete;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace glint
