// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>

/// The notification protocol of systemd; without systemd each of these does nothing.
namespace glint::daemon::systemd {

/// The socket is served. Says nothing about the sensor, or boot would wait for its power.
void notify_ready();
void notify_stopping();
void notify_reloading();
/// One line for `systemctl status`.
void notify_status(const std::string& text);
void notify_watchdog();
/// How often the watchdog wants to be fed, ns; 0 when it is off.
std::int64_t watchdog_period_ns();

}  // namespace glint::daemon::systemd
