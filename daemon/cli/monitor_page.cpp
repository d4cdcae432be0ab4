// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/monitor_page.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/status_text.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

constexpr std::size_t kMostEvents = 50;
/// Rates are told over about so long: steady enough to be read.
constexpr double kRateSpan_s = 2.0;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// What there is to tell of an event beside its kind.
std::string event_text(const Json& event) {
  const std::string kind = event.value("kind", "");
  if (kind == "loop") {
    return fmt::format("{} - {} {}", event["from"].dump(), event["to"].dump(),
                       event["accepted"].get<bool>()
                           ? fmt::format("accepted, moves up to {:.2f} m",
                                         event["largest_correction_m"].get<double>())
                           : "refused: " + event.value("reason", ""));
  }
  if (kind == "job") {
    const Json& job = event["job"];
    return fmt::format("{} {} {}", text_of(job["kind"]), job["id"].dump(), text_of(job["state"])) +
           (job.contains("error") ? ": " + text_of(job["error"]) : "");
  }
  std::string text;
  for (const char* name :
       {"state", "action", "message", "map_epoch", "jump_ns", "removed", "keyframes"}) {
    if (!event.contains(name)) continue;
    const bool bare = event[name].is_string();
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", bare ? "" : std::string(name) + " ",
                        text_of(event[name]));
  }
  return text;
}

std::string event_line(const Json& event) {
  const auto seconds = static_cast<std::time_t>(event.value("t_host_ns", std::int64_t{0}) /
                                                std::int64_t{1'000'000'000});
  return fmt::format("  {:%H:%M:%S}  {:<8} {}", fmt::localtime(seconds), event.value("kind", ""),
                     event_text(event));
}

std::string queue_text(const char* name, const Json& queue) {
  return fmt::format("{} {}/{} ({} dropped)", name, queue["size"].dump(), queue["capacity"].dump(),
                     queue["dropped"].dump());
}

std::string duration_text(double seconds) {
  const auto s = static_cast<std::int64_t>(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

}  // namespace

void MonitorPage::take(const Json& message) {
  const Json& params = message.at("params");
  if (message["method"] == "pose") {
    pose_ = params;
  } else if (message["method"] == "event") {
    // Progress of a job would push everything else out.
    if (params["kind"] == "job" && params["job"].value("progress", 0.0) > 0.0 &&
        params["job"]["state"] == "running") {
      return;
    }
    events_.push_front(event_line(params));
    if (events_.size() > kMostEvents) events_.pop_back();
  } else if (message["method"] == "status") {
    problem_.clear();
    const bool restarted = !status_.is_null() && status_["instance"] != params["instance"];
    if (restarted) earlier_ = status_ = Json();
    if (earlier_.is_null() ||
        params["uptime_s"].get<double>() > earlier_["uptime_s"].get<double>() + 2.0 * kRateSpan_s) {
      earlier_ = status_.is_null() ? params : status_;
    }
    status_ = params;
  }
}

void MonitorPage::lose(std::string why) {
  problem_ = std::move(why);
  earlier_ = Json();
}

double MonitorPage::per_second(const char* counter) const {
  if (earlier_.is_null()) return 0.0;
  const double span_s = status_["uptime_s"].get<double>() - earlier_["uptime_s"].get<double>();
  if (span_s <= 0.0) return 0.0;
  const auto now = status_["counters"].value(counter, std::int64_t{0});
  return static_cast<double>(now - earlier_["counters"].value(counter, std::int64_t{0})) / span_s;
}

void MonitorPage::add_state(std::vector<std::string>& out) const {
  std::string state = fmt::format("state     {}", text_of(status_["state"]));
  if (status_.contains("age_ms")) {
    state += fmt::format(", pose {:.0f} ms old", status_["age_ms"].get<double>());
  }
  out.push_back(state + fmt::format(", map epoch {}", status_["map_epoch"].dump()));
  if (pose_.contains("p_m")) {
    out.push_back(fmt::format("pose      {} m, {} m/s in {}", vector_text(pose_["p_m"], 2),
                              vector_text(pose_["v_mps"], 2), text_of(pose_["frame"])));
  }
  out.push_back(fmt::format("sensor    {} ({}), clock {}", text_of(status_["sensor_state"]),
                            text_of(status_["source"]), text_of(status_["clock"]["source"])));
  for (const char* name : {"sensor_error", "store_error"}) {
    if (status_.contains(name)) out.push_back("          " + text_of(status_[name]));
  }
}

void MonitorPage::add_flow(std::vector<std::string>& out) const {
  out.push_back(fmt::format(
      "rates     {:.0f} lidar and {:.0f} IMU packets, {:.1f} scans, {:.1f} poses a second",
      per_second("lidar_packets"), per_second("imu_packets"), per_second("scans"),
      per_second("poses")));
  out.push_back("losses    " + losses_text(status_["counters"]));
  out.push_back("queues    " + queue_text("packets", status_["queues"]["packets"]) + ", " +
                queue_text("keyframes", status_["queues"]["keyframes"]));
  out.push_back("load      " + text_of(status_["load"]["level"]) + " left out");
  if (status_.contains("odometry")) {
    const Json& odometry = status_["odometry"];
    out.push_back(
        fmt::format("odometry  {} keypoints, {} matches, {} inliers, {:.0f} % of the columns",
                    odometry["keypoints"].dump(), odometry["matches"].dump(),
                    odometry["inliers"].dump(), 100.0 * odometry["completeness"].get<double>()));
  }
}

void MonitorPage::add_map(std::vector<std::string>& out) const {
  const Json& map = status_["map"];
  const Json& counters = status_["counters"];
  out.push_back(fmt::format(
      "map       {} points in {} tiles, {} keyframes, {:.1f} MB and {:.1f} MB on the disk{}",
      map["points"].dump(), map["tiles"].dump(), map["keyframes"].dump(),
      map["memory_mb"].get<double>(), map["disk_mb"].get<double>(),
      map["full"].get<bool>() ? ", FULL" : ""));
  out.push_back(fmt::format("loops     {} accepted, {} refused", counters["loops_accepted"].dump(),
                            counters["loops_rejected"].dump()));
}

void MonitorPage::add_stages(std::vector<std::string>& out) const {
  out.push_back(fmt::format("stage ms  {:<18}{:>9}{:>9}{:>9}", "", "last", "mean", "max"));
  for (const auto& [name, ms] : status_["stage_ms"].items()) {
    out.push_back(fmt::format("          {:<18}{:>9.2f}{:>9.2f}{:>9.2f}", name,
                              ms["last"].get<double>(), ms["mean"].get<double>(),
                              ms["max"].get<double>()));
  }
}

std::vector<std::string> MonitorPage::lines() const {
  std::vector<std::string> out;
  out.push_back(fmt::format("glintd at {}   (q leaves)", target_));
  if (!problem_.empty()) out.push_back("NOT CONNECTED: " + problem_);
  if (status_.is_null()) return out;
  out.push_back(fmt::format("daemon    {}, up {}, {} clients, {:.0f} MB",
                            text_of(status_["version"]),
                            duration_text(status_["uptime_s"].get<double>()),
                            status_["clients"].dump(), status_["rss_mb"].get<double>()));
  add_state(out);
  add_flow(out);
  add_map(out);
  add_stages(out);
  out.emplace_back("events");
  out.insert(out.end(), events_.begin(), events_.end());
  return out;
}

}  // namespace glint::cli
