// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/session_runner.hpp"

#include <boost/asio/post.hpp>
#include <chrono>

namespace glint {

/// Shared with what waits in the io_context, which may run after the runner has gone.
struct SessionRunner::Impl : std::enable_shared_from_this<Impl> {
  Impl(boost::asio::io_context& context, SensorSession& a_session, Clock a_clock)
      : io(context), timer(context), session(a_session), clock(a_clock) {}

  void wake() {
    boost::asio::post(io, [self = shared_from_this()] { self->step(); });
  }

  void step() {
    if (stopped) return;
    const std::int64_t now_ns = clock.monotonic_ns();
    const std::int64_t wait_ns = std::max<std::int64_t>(0, session.step(now_ns) - now_ns);
    timer.expires_after(std::chrono::nanoseconds(wait_ns));
    timer.async_wait([self = shared_from_this()](boost::system::error_code error) {
      if (!error) self->step();
    });
  }

  boost::asio::io_context& io;
  boost::asio::steady_timer timer;
  SensorSession& session;
  const Clock clock;
  bool stopped = false;
};

SessionRunner::SessionRunner(boost::asio::io_context& io, SensorSession& session, Clock clock)
    : impl_(std::make_shared<Impl>(io, session, clock)) {
  session.set_wake([impl = impl_.get()] { impl->wake(); });
  impl_->wake();
}

SessionRunner::~SessionRunner() {
  impl_->session.set_wake(nullptr);
  impl_->stopped = true;
  boost::system::error_code ignored;
  impl_->timer.cancel(ignored);
}

}  // namespace glint
