// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <random>

#include "daemon/protocol_map.hpp"
#include "daemon/sensor_link.hpp"
#include "daemon/version.hpp"

namespace glint::daemon {
namespace {

/// What hello announces: only what works.
constexpr std::array kFeatures = {"get_pose",         "get_pose.at_ns", "get_pose.predict_ms",
                                  "get_status",       "get_map",        "get_trajectory",
                                  "get_config",       "subscribe.pose", "subscribe.status",
                                  "subscribe.events", "unsubscribe",    "pause",
                                  "resume",           "reset_odometry"};

/// Tells one run of the daemon from the next.
std::string random_instance() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

}  // namespace

Api::Api(boost::asio::io_context& io, Runtime& runtime, const Config& config)
    : io_(io),
      runtime_(runtime),
      config_(config),
      instance_(random_instance()),
      start_ns_(steady_now_ns()) {}

Api::Method Api::find_method(std::string_view name) {
  struct Entry {
    std::string_view name;
    Method method;
  };
  static constexpr std::array<Entry, 7> kMethods = {
      {{"get_pose", &Api::call_get_pose},
       {"get_status", &Api::call_get_status},
       {"get_trajectory", &Api::call_get_trajectory},
       {"get_config", &Api::call_get_config},
       {"pause", &Api::call_pause},
       {"resume", &Api::call_resume},
       {"reset_odometry", &Api::call_reset_odometry}}};
  const auto* found = std::ranges::find(kMethods, name, &Entry::name);
  return found == kMethods.end() ? nullptr : found->method;
}

void Api::call(const Request& request, Reply reply) {
  if (request.method == "get_map") return call_get_map(request, std::move(reply));
  const Method method = find_method(request.method);
  if (method == nullptr) {
    throw RpcError(kMethodNotFound, fmt::format("there is no method '{}'", request.method),
                   "method");
  }
  const Json result = (this->*method)(request.params);
  std::string line = result_line(request.id, result);
  if (line.size() > kMaxLineBytes) {
    throw RpcError(kTooLarge, "the answer is longer than the longest line; ask for less");
  }
  reply(std::move(line));
}

std::string Api::hello_line() const {
  const auto snapshot = runtime_.snapshot();
  return notification_line("hello", Json{{"protocol", "1.0"},
                                         {"server", fmt::format("glintd {}", kVersion)},
                                         {"instance", instance_},
                                         {"map_epoch", snapshot->correction.epoch},
                                         {"max_line", kMaxLineBytes},
                                         {"features", kFeatures}});
}

PoseContext Api::context() const {
  return {config_.mount.T_base_sensor, runtime_.scan_period_ns()};
}

Json Api::status() const {
  ServiceStatus service;
  service.instance = instance_;
  service.source_name = runtime_.options().source_name;
  service.uptime_ns = steady_now_ns() - start_ns_;
  service.scan_period_ns = runtime_.scan_period_ns();
  if (sensor_ != nullptr) {
    service.session = &sensor_->status();
    service.sensor_problem = sensor_->problem();
  }
  service.clients = client_count_;
  return status_json(runtime_.status(), service, steady_now_ns());
}

Json Api::pose(const Snapshot& snapshot, PoseFrames frames) const {
  return newest_pose_json(snapshot, frames, context(), steady_now_ns());
}

Json Api::head() const {
  const auto snapshot = runtime_.snapshot();
  const auto state = client_state(*snapshot, steady_now_ns(), runtime_.scan_period_ns());
  Json out{{"sensor", 0}, {"state", slam::to_string(state)}};
  if (snapshot->estimate) put_time(out, snapshot->estimate->stamp);
  out["map_epoch"] = snapshot->correction.epoch;
  return out;
}

Json Api::call_get_pose(const Json& params) {
  return get_pose(params, *runtime_.snapshot(), context(), steady_now_ns());
}

Json Api::call_get_status(const Json&) { return status(); }

Json Api::call_get_trajectory(const Json& params) {
  return get_trajectory(params, *runtime_.snapshot(), context(), steady_now_ns());
}

Json Api::call_get_config(const Json&) {
  Json out = head();
  out["config"] = to_json(config_);
  return out;
}

Json Api::call_pause(const Json&) { return post_command(PauseCommand{}); }
Json Api::call_resume(const Json&) { return post_command(ResumeCommand{}); }
Json Api::call_reset_odometry(const Json&) { return post_command(ResetOdometryCommand{}); }

Json Api::post_command(Command command) {
  runtime_.post(std::move(command));
  Json out = head();
  out["accepted"] = true;
  return out;
}

void Api::call_get_map(const Request& request, Reply reply) {
  const MapQuery query = parse_map_query(request.params);
  auto job = [this, query, id = request.id, head = head(), reply = std::move(reply)]() mutable {
    Json result = std::move(head);
    result.update(map_page(query, *runtime_.status().map->map));
    std::string line = result_line(id, result);
    boost::asio::post(io_, [reply = std::move(reply), line = std::move(line)]() mutable {
      reply(std::move(line));
    });
  };
  if (!runtime_.submit(std::move(job))) {
    throw RpcError(kBusy, "too many map queries are waiting; ask again");
  }
}

}  // namespace glint::daemon
