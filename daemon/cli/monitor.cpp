// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint watch --monitor: status, pose and events on the whole terminal, as they come.
#include "daemon/cli/monitor.hpp"

#include <chrono>
#include <thread>

#include "daemon/cli/monitor_page.hpp"
#include "daemon/cli/terminal_screen.hpp"

namespace glint::cli {
namespace {

using daemon::Json;
using std::chrono::milliseconds;

constexpr double kPageRate_hz = 4.0;
/// A daemon that tells nothing for so long, of what it is to tell four times a second, is gone.
constexpr milliseconds kMonitorSilence{3000};
constexpr milliseconds kKeyPeriod{100};
constexpr int kKeyPeriodsUntilRetry = 10;

void follow(daemon::Client& client, MonitorPage& page, const TerminalScreen& screen) {
  client.call("subscribe", {{"topics", {"pose", "status", "events"}}, {"rate_hz", kPageRate_hz}});
  while (!screen.leaving()) {
    const Json message = client.next_message(kMonitorSilence);
    if (!message.contains("method")) continue;
    page.take(message);
    // One drawing for what comes together: the status comes last.
    if (message["method"] == "status") screen.show(page.lines());
  }
}

}  // namespace

void run_monitor(const ClientOptions& options) {
  const TerminalScreen screen;
  MonitorPage page(options.connect);
  screen.show(page.lines());
  while (!screen.leaving()) {
    try {
      with_client(options, [&](daemon::Client& client) { follow(client, page, screen); });
    } catch (const std::runtime_error& error) {  // No connection any more, or BUSY.
      page.lose(error.what());
    }
    for (int i = 0; i < kKeyPeriodsUntilRetry && !screen.leaving(); ++i) {
      screen.show(page.lines());
      std::this_thread::sleep_for(kKeyPeriod);
    }
  }
}

}  // namespace glint::cli
