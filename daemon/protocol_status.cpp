// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_status.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>

#include "daemon/version.hpp"

namespace glint::daemon {
namespace {

constexpr double kMsPerNs = 1e-6;
constexpr double kMbPerByte = 1e-6;

/// Resident memory now, MB.
double resident_mb() {
  unsigned long total = 0;
  unsigned long resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu %lu", &total, &resident) != 2) resident = 0;
    static_cast<void>(std::fclose(file));
  }
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

Json counters_json(const RuntimeStatus& runtime) {
  const Snapshot& snapshot = *runtime.snapshot;
  const AssemblerCounters& c = snapshot.packets;
  return Json{{"received_packets", runtime.packets_received},
              {"kernel_drops", runtime.kernel_drops},
              {"foreign_packets", runtime.foreign + c.bad_serial},
              {"queue_drops", runtime.packets.dropped},
              {"early_packets", snapshot.early_packets},
              {"lidar_packets", c.packets},
              {"imu_packets", snapshot.imu.packets},
              {"bad_imu_packets", snapshot.imu.bad_packets},
              {"bad_size", c.bad_size},
              {"bad_type", c.bad_type},
              {"bad_serial", c.bad_serial},
              {"corrupt_packets", c.corrupt_packets},
              {"crc_mismatches", c.crc_mismatches},
              {"bad_columns", c.bad_column},
              {"late_packets", c.late_packets},
              {"duplicate_packets", c.duplicate_packets},
              {"stray_packets", c.stray_packets},
              {"zone_packets", c.zone_packets},
              {"missing_packets", c.missing_packets},
              {"never_arrived", c.missing_packets},
              {"clock_jumps", c.clock_jumps},
              {"sensor_restarts", c.restarts},
              {"scans", c.scans},
              {"incomplete_scans", c.incomplete_scans},
              {"paused_scans", snapshot.paused_scans},
              {"poses", snapshot.scans},
              {"dropped_keyframes", snapshot.dropped_keyframes},
              {"store_failures", runtime.map->store_failures},
              {"loops_accepted", runtime.map->loops_accepted},
              {"loops_rejected", runtime.map->loops_rejected}};
}

Json duration_json(const DurationStats& stats) {
  return Json{{"last", static_cast<double>(stats.last_ns) * kMsPerNs},
              {"mean", static_cast<double>(stats.sum_ns) /
                           static_cast<double>(std::max<std::uint64_t>(1, stats.count)) * kMsPerNs},
              {"max", static_cast<double>(stats.max_ns) * kMsPerNs}};
}

/// Only stages that have run.
Json stages_json(const RuntimeStatus& runtime) {
  const StageStats stats = all_stages(runtime);
  Json out = Json::object();
  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    if (stats.stages[i].count == 0) continue;
    out[std::string(slam::kStageNames[i])] = duration_json(stats.stages[i]);
  }
  return out;
}

Json load_json(const Snapshot& snapshot) {
  Json shed = Json::object();
  for (std::size_t i = 1; i < slam::kLoadLevels; ++i) {
    shed[std::string(slam::kLoadLevelNames[i])] = snapshot.shed_scans[i];
  }
  const auto level = static_cast<std::size_t>(snapshot.load_level);
  return Json{{"level", slam::kLoadLevelNames[level]}, {"shed_scans", std::move(shed)}};
}

Json queue_json(const QueueStatus& queue) {
  return Json{{"size", queue.size}, {"capacity", queue.capacity}, {"dropped", queue.dropped}};
}

Json server_json(const ServerCounters& c) {
  return Json{{"accepted_clients", c.accepted_clients},
              {"refused_clients", c.refused_clients},
              {"failed_accepts", c.failed_accepts},
              {"junk_clients", c.junk_clients},
              {"idle_clients", c.idle_clients},
              {"slow_clients", c.slow_clients},
              {"failed_handshakes", c.failed_handshakes},
              {"failed_authentications", c.failed_authentications},
              {"requests", c.requests},
              {"bad_requests", c.bad_requests},
              {"forbidden_requests", c.forbidden_requests},
              {"throttled_requests", c.throttled_requests},
              {"missed_notifications", c.missed_notifications},
              {"unsent_poses", c.unsent_poses},
              {"scrapes", c.scrapes},
              {"refused_scrapes", c.refused_scrapes}};
}

Json jobs_json(const std::vector<JobReport>& jobs) {
  Json out = Json::array();
  for (const JobReport& job : jobs) out.push_back(job_json(job));
  return out;
}

Json odometry_json(const slam::OdometryEstimate& estimate) {
  return Json{{"frame_id", estimate.frame_id},         {"segment", estimate.segment},
              {"completeness", estimate.completeness}, {"keypoints", estimate.keypoints},
              {"matches", estimate.matches},           {"inliers", estimate.inliers}};
}

/// What there is to say of the sensor, the nearest cause first.
std::string sensor_error(const RuntimeStatus& runtime, const ServiceStatus& service) {
  if (!runtime.source_error.empty()) return runtime.source_error;
  if (!service.sensor_problem.empty()) return service.sensor_problem;
  return refusal_sentence(runtime);
}

std::string_view sensor_state(const RuntimeStatus& runtime, const ServiceStatus& service) {
  const bool over = runtime.source == SourceState::kFailed || runtime.source == SourceState::kEnded;
  return service.session == nullptr || over ? to_string(runtime.source)
                                            : to_string(service.session->state);
}

Json clock_json(const Snapshot& snapshot) {
  Json out{{"source", to_string(snapshot.clock_source)}};
  if (!snapshot.clock.known) return out;
  out["offset_ns"] = snapshot.clock.offset_ns;
  out["skew_ppm"] = snapshot.clock.skew_ppm;
  out["sigma_ns"] = snapshot.clock.sigma_ns;
  out["jumps"] = snapshot.clock.jumps;
  return out;
}

Json imu_json(const ImuStatus& imu) {
  Json out{{"rate_hz", imu.rate_hz}};
  if (!imu.up_mps2) return out;
  out["gravity_mps2"] = Json{imu.up_mps2->x(), imu.up_mps2->y(), imu.up_mps2->z()};
  out["mount_tilt_deg"] = imu.mount_tilt_deg;
  return out;
}

}  // namespace

std::string refusal_sentence(const RuntimeStatus& runtime) {
  if (!runtime.sensor) return {};
  const SensorInfo& info = *runtime.sensor;
  const RefusedPacket& refused = runtime.snapshot->refused;
  if (refused.init_id != 0) {
    return fmt::format(
        "packets are of the sensor's start {}, metadata of its start {}; they are read anew",
        refused.init_id, info.init_id);
  }
  // Beside the sensor's packets strange ones are no reason why nothing comes of it.
  if (runtime.snapshot->packets.packets > 0) return {};
  if (refused.serial_number != 0) {
    return fmt::format(
        "packets are of the sensor {}, metadata of {}; give the metadata of that sensor, or name "
        "the wanted one with sensor.source_address",
        refused.serial_number, info.serial_number);
  }
  if (refused.bytes == 0) return {};
  return fmt::format(
      "packets have {} bytes, those of the metadata's sensor ({} {}, {}) have {}; give the "
      "metadata "
      "of the sensor that sends them",
      refused.bytes, info.product_line, info.serial_number, info.lidar_mode,
      PacketFormat(info).packet_bytes);
}

std::string_view to_string(SourceState state) {
  switch (state) {
    case SourceState::kWaiting:
      return "WAITING_DATA";
    case SourceState::kRunning:
      return "RUNNING";
    case SourceState::kStalled:
      return "STALLED";
    case SourceState::kEnded:
      return "ENDED";
    case SourceState::kFailed:
      return "FAILED";
  }
  return "FAILED";
}

StageStats all_stages(const RuntimeStatus& runtime) {
  StageStats stats = runtime.snapshot->stages;
  stats[slam::Stage::kBackend] = runtime.map->backend;
  stats[slam::Stage::kPgo] = runtime.map->pgo;
  return stats;
}

Json status_json(const RuntimeStatus& runtime, const ServiceStatus& service, std::int64_t now_ns) {
  const Snapshot& snapshot = *runtime.snapshot;
  Json out{{"sensor", 0},
           {"state", slam::to_string(client_state(snapshot, now_ns, service.scan_period_ns))},
           {"sensor_state", sensor_state(runtime, service)}};
  if (const std::string error = sensor_error(runtime, service); !error.empty()) {
    out["sensor_error"] = error;
  }
  if (snapshot.packet_health) out["packet_health"] = packet_health_json(*snapshot.packet_health);
  if (service.session != nullptr) out["sensor_session"] = session_json(*service.session, now_ns);
  if (snapshot.estimate) {
    put_time(out, snapshot.estimate->stamp);
    out["age_ms"] = static_cast<double>(now_ns - snapshot.arrival_ns) * kMsPerNs;
    out["odometry"] = odometry_json(*snapshot.estimate);
  }
  out["clock"] = clock_json(snapshot);
  if (snapshot.imu.packets > 0) out["imu"] = imu_json(snapshot.imu);
  out["map_epoch"] = snapshot.correction.epoch;
  if (!snapshot.correction.placed || runtime.map->only_read) {
    out["localization"] = Json{{"confidence", snapshot.correction.confidence}};
  }
  const slam::MapSnapshot& map = *runtime.map->map;
  out["map"] = Json{{"revision", map.revision},
                    {"tiles", map.tiles.size()},
                    {"points", map.point_count},
                    {"points_refused", map.points_refused},
                    {"keyframes", map.keyframe_count},
                    {"only_read", runtime.map->only_read},
                    {"memory_mb", static_cast<double>(runtime.map->memory.bytes) * kMbPerByte},
                    {"disk_mb", static_cast<double>(runtime.map->memory.disk_bytes) * kMbPerByte},
                    {"full", runtime.map->memory.full}};
  if (runtime.map->restored < 1.0) out["map"]["restored"] = runtime.map->restored;
  if (const auto count = runtime.map->unreadable_keyframes; count > 0) {
    out["map"]["unreadable_keyframes"] = count;
  }
  out["counters"] = counters_json(runtime);
  out["counters"]["sessions_removed"] = service.sessions_removed;
  out["stage_ms"] = stages_json(runtime);
  out["load"] = load_json(*runtime.snapshot);
  out["jobs"] = jobs_json(runtime.jobs);
  out["queues"] =
      Json{{"packets", queue_json(runtime.packets)}, {"keyframes", queue_json(runtime.keyframes)}};
  out["source"] = service.source_name;
  out["session_file"] = runtime.map->session_file;
  if (!runtime.map->store_error.empty()) out["store_error"] = runtime.map->store_error;
  out["clients"] = service.clients;
  if (service.server != nullptr) out["server"] = server_json(*service.server);
  out["rss_mb"] = resident_mb();
  out["uptime_s"] = static_cast<double>(service.uptime_ns) * kSecondsPerNs;
  out["version"] = kVersion;
  out["instance"] = service.instance;
  return out;
}

}  // namespace glint::daemon
