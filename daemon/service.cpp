// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/service.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>

#include "daemon/protocol_status.hpp"
#include "daemon/session_files.hpp"
#include "daemon/steady_clock.hpp"
#include "daemon/systemd_notify.hpp"
#include "slam/loops/loops_by_appearance.hpp"

namespace glint::daemon {
namespace {

constexpr std::int64_t kSupervisionNs = kNsPerSecond;
constexpr std::uint64_t kMegabyte = 1'000'000;

/// Between two looks: often enough for the watchdog, and for the log.
std::chrono::nanoseconds supervision_period() {
  const std::int64_t watchdog_ns = systemd::watchdog_period_ns();
  return std::chrono::nanoseconds(watchdog_ns > 0 ? std::min(watchdog_ns, kSupervisionNs)
                                                  : kSupervisionNs);
}

RuntimeOptions with_session_and_loops(RuntimeOptions options, const Config& config) {
  options.session = plan_session(config);
  options.loops = [slam = config.slam] { return slam::loops_by_appearance(slam); };
  if (options.session.file.empty()) {
    spdlog::info("no session is kept: state.directory is not set");
  }
  return options;
}

}  // namespace

Service::Service(boost::asio::io_context& io, const Config& config, Input input, Reload reload)
    : config_(config),
      reload_(std::move(reload)),
      io_(io),
      runtime_(input.info, config, std::move(input.source),
               with_session_and_loops(input.options, config)),
      api_(io_, runtime_, config),
      server_(io_, api_, config),
      signals_(io_, SIGINT, SIGTERM, SIGHUP),
      timer_(io_) {
  if (!config.metrics.listen.empty()) {
    metrics_.emplace(io_, api_, server_.access(), server_.counters(), config.metrics.listen);
  }
  if (!input.sensor) return;
  sensor_.emplace(io_, runtime_, *input.sensor);
  api_.set_sensor(*sensor_);
}

// After the session of now was opened, which may be one that goes on.
void Service::make_room_for_sessions() {
  const std::filesystem::path& current = runtime_.options().session.file;
  if (current.empty() || config_.state.max_sessions_mb == 0) return;
  const auto most_bytes = static_cast<std::uint64_t>(config_.state.max_sessions_mb) * kMegabyte;
  const auto removed = remove_old_sessions(current.parent_path(), most_bytes, current);
  for (const RemovedSession& session : removed) {
    const std::string name = session.file.filename().string();
    spdlog::info("removed the old session {}, {:.1f} MB: state.max_sessions_mb is {}", name,
                 static_cast<double>(session.bytes) / kMegabyte, config_.state.max_sessions_mb);
    runtime_.events().post({"session", 0, {{"removed", name}, {"bytes", session.bytes}}});
  }
  api_.set_sessions_removed(removed.size());
}

int Service::run() {
  make_room_for_sessions();
  runtime_.start([this](const auto& snapshot) { server_.publish(snapshot); });
  server_.start();
  if (metrics_) metrics_->start();
  wait_for_signal();
  supervise();
  if (server_.tcp_port() != 0) {
    spdlog::info("serving {} on TCP port {}", runtime_.options().source_name, server_.tcp_port());
  }
  if (!server_.unix_path().empty()) spdlog::info("serving on {}", server_.unix_path());
  if (metrics_) spdlog::info("serving metrics on port {}", metrics_->port());
  systemd::notify_ready();
  io_.run();
  runtime_.stop();
  look_at_health();
  spdlog::info("stopped after {} poses", runtime_.snapshot()->scans);
  return exit_code_;
}

void Service::wait_for_signal() {
  signals_.async_wait([this](boost::system::error_code error, int signal) {
    if (error) return;
    if (signal != SIGHUP) {
      spdlog::info("stopping on {}", signal == SIGTERM ? "SIGTERM" : "SIGINT");
      return stop(0);
    }
    reload();
    wait_for_signal();
  });
}

void Service::reload() {
  systemd::notify_reloading();
  try {
    const Config fresh = reload_();
    const Json before = to_json(config_).flatten();
    const Json after = to_json(fresh).flatten();
    for (const auto& [pointer, value] : after.items()) {
      if (before.value(pointer, Json()) == value || pointer == "/log/level") continue;
      spdlog::warn("reload: {} = {} takes effect at the next start only", pointer, value.dump());
    }
    server_.read_secrets_again(config_.server);
    config_.log = fresh.log;
    set_log_level(fresh.log.level);
    spdlog::info("reload: log.level is {}", fresh.log.level);
  } catch (const ConfigError& error) {
    spdlog::error("reload: nothing changed: {}", error.what());
  }
  systemd::notify_ready();
}

RuntimeStatus Service::look_at_health() {
  RuntimeStatus status = runtime_.status();
  if (!sensor_) health_.look_at_source(status, runtime_.events());
  health_.look(status, steady_now_ns(), runtime_.scan_period_ns());
  return status;
}

void Service::supervise() {
  const RuntimeStatus status = look_at_health();
  const Json told = api_.status();
  systemd::notify_status(
      fmt::format("{}, sensor {}, {} clients", told["state"].get<std::string_view>(),
                  told["sensor_state"].get<std::string_view>(), server_.client_count()));
  if (const std::string fault = runtime_.fault(); !fault.empty()) {
    spdlog::critical("stopping: {}", fault);
    return stop(1);
  }
  if (status.source == SourceState::kFailed && !runtime_.options().lossless) {
    spdlog::critical("stopping: the packet source broke: {}", status.source_error);
    return stop(1);
  }
  if (runtime_.alive(kThreadLimitNs)) systemd::notify_watchdog();

  timer_.expires_after(supervision_period());
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) supervise();
  });
}

void Service::stop(int exit_code) {
  exit_code_ = exit_code;
  systemd::notify_stopping();
  server_.close();
  if (metrics_) metrics_->close();
  io_.stop();
}

}  // namespace glint::daemon
