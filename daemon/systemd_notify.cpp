// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/systemd_notify.hpp"

#include <systemd/sd-daemon.h>

#include "daemon/steady_clock.hpp"

namespace glint::daemon::systemd {
namespace {

// A message that systemd does not take is no reason to do anything else.
void notify(const std::string& message) { static_cast<void>(sd_notify(0, message.c_str())); }

}  // namespace

void notify_ready() { notify("READY=1"); }
void notify_stopping() { notify("STOPPING=1"); }
void notify_reloading() {
  notify("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(steady_now_ns() / 1000));
}
void notify_status(const std::string& text) { notify("STATUS=" + text); }
void notify_watchdog() { notify("WATCHDOG=1"); }

std::int64_t watchdog_period_ns() {
  std::uint64_t timeout_us = 0;
  if (sd_watchdog_enabled(0, &timeout_us) <= 0) return 0;
  // Half of the time-out, as sd_watchdog_enabled(3) advises.
  return static_cast<std::int64_t>(timeout_us) * 1000 / 2;
}

}  // namespace glint::daemon::systemd
