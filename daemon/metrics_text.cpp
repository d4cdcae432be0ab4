// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/metrics_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace glint::daemon {
namespace {

constexpr double kMetricsSecondsPerNs = 1e-9;
constexpr double kMetricsSecondsPerMs = 1e-3;
constexpr double kMetricsBytesPerMb = 1e6;

constexpr std::array<std::string_view, 6> kTrackingStates = {"INIT", "TRACKING",   "DEGRADED",
                                                             "LOST", "LOCALIZING", "PAUSED"};
constexpr std::array<std::string_view, 7> kSensorStates = {
    "DISCOVERING", "CONFIGURING", "WAITING_DATA", "RUNNING", "STALLED", "ENDED", "FAILED"};
/// Counters of the status that may fall: a loop may be taken back.
constexpr std::array<std::string_view, 2> kFallingCounters = {"loops_accepted", "loops_rejected"};

std::string escaped(std::string_view value) {
  std::string out;
  for (const char c : value) {
    if (c == '\\' || c == '"') out += '\\';
    out += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return out;
}

/// Families of samples, each under its HELP and TYPE.
class MetricsWriter {
 public:
  void family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP glint_{} {}\n# TYPE glint_{} {}\n", name,
                   help, name, type);
  }
  /// Of the family begun last. `labels` without braces.
  void sample(double value, std::string_view labels = {}, std::string_view suffix = {}) {
    text_ += fmt::format("glint_{}{}", name_, suffix);
    if (!labels.empty()) text_ += fmt::format("{{{}}}", labels);
    text_ += fmt::format(" {}\n", value);
  }
  void gauge(std::string_view name, double value, std::string_view help) {
    family(name, "gauge", help);
    sample(value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string name_;
  std::string text_;
};

std::string label(std::string_view name, std::string_view value) {
  return fmt::format("{}=\"{}\"", name, escaped(value));
}

void write_counters(MetricsWriter& out, const Json& counters, std::string_view prefix,
                    std::string_view group) {
  for (const auto& [name, value] : counters.items()) {
    const bool falls = std::ranges::find(kFallingCounters, name) != kFallingCounters.end();
    out.family(fmt::format("{}{}{}", prefix, name, falls ? "" : "_total"),
               falls ? "gauge" : "counter",
               fmt::format("{} in {} of get_status, see PROTOCOL.md.", name, group));
    out.sample(value.get<double>());
  }
}

/// 1 for the state that is, 0 for the others.
void write_state(MetricsWriter& out, std::string_view name, std::span<const std::string_view> all,
                 const std::string& now, std::string_view help) {
  out.family(name, "gauge", help);
  for (const std::string_view state : all) out.sample(state == now ? 1 : 0, label("state", state));
}

void write_queues(MetricsWriter& out, const Json& queues) {
  const auto each = [&](std::string_view name, std::string_view type, const char* field,
                        std::string_view help) {
    out.family(name, type, help);
    for (const auto& [queue, values] : queues.items()) {
      out.sample(values[field].get<double>(), label("queue", queue));
    }
  };
  each("queue_size", "gauge", "size", "What waits in a queue.");
  each("queue_capacity", "gauge", "capacity", "What a queue holds at most.");
  each("queue_dropped_total", "counter", "dropped", "What a full queue lost.");
}

void write_load(MetricsWriter& out, const Json& load) {
  out.family("load_level", "gauge", "What odometry leaves out now so that the machine keeps up.");
  const auto now = load["level"].get<std::string>();
  out.sample(now == "none" ? 1 : 0, label("level", "none"));
  for (const auto& [level, scans] : load["shed_scans"].items()) {
    out.sample(now == level ? 1 : 0, label("level", level));
  }
  out.family("shed_scans_total", "counter", "Scans of which something was to be left out.");
  for (const auto& [level, scans] : load["shed_scans"].items()) {
    out.sample(scans.get<double>(), label("level", level));
  }
}

void write_odometry(MetricsWriter& out, const Json& status) {
  if (!status.contains("odometry")) return;
  const Json& odometry = status["odometry"];
  out.gauge("pose_age_seconds", status["age_ms"].get<double>() * kMetricsSecondsPerMs,
            "Age of the newest pose.");
  out.gauge("scan_completeness_ratio", odometry["completeness"].get<double>(),
            "Share of the newest scan's columns that came.");
  out.gauge("scan_keypoints", odometry["keypoints"].get<double>(), "Keypoints of the newest scan.");
  out.gauge("scan_matches", odometry["matches"].get<double>(), "Matches of the newest scan.");
  out.gauge("scan_inliers", odometry["inliers"].get<double>(), "Inliers of the newest scan.");
  out.gauge("segment", odometry["segment"].get<double>(),
            "Steps when tracking restarts without a link to what came before.");
}

void write_map(MetricsWriter& out, const Json& status) {
  const Json& map = status["map"];
  out.gauge("map_epoch", status["map_epoch"].get<double>(), "Steps when the map is corrected.");
  out.gauge("map_points", map["points"].get<double>(), "Points in the map.");
  out.gauge("map_tiles", map["tiles"].get<double>(), "Tiles of the map.");
  out.gauge("map_keyframes", map["keyframes"].get<double>(), "Keyframes of the map.");
  out.gauge("map_memory_bytes", map["memory_mb"].get<double>() * kMetricsBytesPerMb,
            "Memory of map, graph and known places.");
  out.gauge("map_disk_bytes", map["disk_mb"].get<double>() * kMetricsBytesPerMb,
            "What was set aside on the disk.");
  out.gauge("map_full", map["full"].get<bool>() ? 1 : 0, "Whether the map has stopped growing.");
}

void write_clock(MetricsWriter& out, const Json& status) {
  const Json& clock = status["clock"];
  if (clock.contains("skew_ppm")) {
    out.gauge("clock_skew_ppm", clock["skew_ppm"].get<double>(),
              "Skew of the sensor's clock to this machine's, parts per million.");
    out.gauge("clock_sigma_seconds", clock["sigma_ns"].get<double>() * kMetricsSecondsPerNs,
              "How far off the relation of the two clocks may be.");
  }
  if (status.contains("imu")) {
    out.gauge("imu_rate_hertz", status["imu"]["rate_hz"].get<double>(), "IMU measurements.");
  }
}

void write_stages(MetricsWriter& out, const StageStats& stages) {
  out.family("stage_duration_seconds", "histogram",
             "Wall time of a stage for one scan; pgo and backend for one keyframe.");
  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const DurationStats& stats = stages.stages[i];
    const std::string stage = label("stage", slam::kStageNames[i]);
    std::uint64_t below = 0;
    for (std::size_t b = 0; b < kDurationBounds_ns.size(); ++b) {
      below += stats.buckets[b];
      const double bound_s = static_cast<double>(kDurationBounds_ns[b]) * kMetricsSecondsPerNs;
      out.sample(static_cast<double>(below), fmt::format("{},le=\"{:g}\"", stage, bound_s),
                 "_bucket");
    }
    out.sample(static_cast<double>(stats.count), stage + ",le=\"+Inf\"", "_bucket");
    out.sample(static_cast<double>(stats.sum_ns) * kMetricsSecondsPerNs, stage, "_sum");
    out.sample(static_cast<double>(stats.count), stage, "_count");
  }
}

void write_process(MetricsWriter& out, const Json& status) {
  out.family("build_info", "gauge", "Always 1; the labels say what runs.");
  out.sample(1, label("version", status["version"].get<std::string>()) + "," +
                    label("source", status["source"].get<std::string>()));
  out.gauge("uptime_seconds", status["uptime_s"].get<double>(), "Time since the start.");
  out.gauge("resident_memory_bytes", status["rss_mb"].get<double>() * kMetricsBytesPerMb,
            "Resident memory of the process.");
  out.gauge("clients", status["clients"].get<double>(), "Clients connected now.");
  const auto is_running = [](const Json& job) { return job["state"] == "running"; };
  out.gauge("jobs_running", static_cast<double>(std::ranges::count_if(status["jobs"], is_running)),
            "Jobs that run now.");
}

}  // namespace

std::string metrics_text(const Json& status, const StageStats& stages) {
  MetricsWriter out;
  write_process(out, status);
  write_state(out, "state", kTrackingStates, status["state"].get<std::string>(),
              "1 for the state of tracking.");
  write_state(out, "sensor_state", kSensorStates, status["sensor_state"].get<std::string>(),
              "1 for the state of the sensor.");
  write_odometry(out, status);
  write_map(out, status);
  write_clock(out, status);
  write_load(out, status["load"]);
  write_queues(out, status["queues"]);
  write_counters(out, status["counters"], "", "counters");
  if (status.contains("server")) write_counters(out, status["server"], "server_", "server");
  write_stages(out, stages);
  return out.take();
}

}  // namespace glint::daemon
