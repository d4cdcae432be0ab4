// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/health_log.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/protocol_status.hpp"

namespace glint::daemon {

void HealthLog::look_at_source(const RuntimeStatus& status, EventLog& events) {
  if (status.source == source_) return;
  source_ = status.source;
  spdlog::info("sensor: {}{}{}", to_string(source_), status.source_error.empty() ? "" : ": ",
               status.source_error);
  for (const std::string& notice : status.source_notices) spdlog::warn("{}", notice);
  Json fields{{"state", to_string(source_)}};
  if (!status.source_error.empty()) fields["message"] = status.source_error;
  events.post({"sensor", 0, std::move(fields)});
}

void HealthLog::look(const RuntimeStatus& status, std::int64_t now_ns,
                     std::int64_t scan_period_ns) {
  const auto tracking = client_state(*status.snapshot, now_ns, scan_period_ns);
  if (tracking != tracking_ && limiter_.allow("tracking", now_ns)) {
    tracking_ = tracking;
    spdlog::info("tracking: {}", slam::to_string(tracking));
  }
  if (status.map->map->epoch != map_epoch_ && limiter_.allow("epoch", now_ns)) {
    map_epoch_ = status.map->map->epoch;
    spdlog::info("the map has changed: epoch {}, {} loops closed, {} candidates refused",
                 map_epoch_, status.map->loops_accepted, status.map->loops_rejected);
  }
  const AssemblerCounters& packets = status.snapshot->packets;
  look_at_refusals(status, packets.bad_size + packets.bad_serial + status.snapshot->early_packets,
                   now_ns);
  look_at_counter("kernel_drops",
                  "packets dropped by the kernel, its receive buffer was full (raise "
                  "net.core.rmem_max)",
                  status.kernel_drops, now_ns);
  look_at_counter("queue_drops", "packets dropped, odometry was too slow", status.packets.dropped,
                  now_ns);
  look_at_counter("missing_packets", "packets that never came", packets.missing_packets, now_ns);
  look_at_counter("late_packets", "packets that came too late", packets.late_packets, now_ns);
  look_at_counter("corrupt_packets", "packets damaged on the way, their checksum is wrong",
                  packets.corrupt_packets, now_ns);
  look_at_counter("bad_size", "datagrams of another size than the sensor's packets",
                  packets.bad_size, now_ns);
  look_at_counter("bad_type", "datagrams of another type than lidar packets", packets.bad_type,
                  now_ns);
  look_at_counter("bad_serial", "packets of another sensor", packets.bad_serial, now_ns);
  look_at_counter("clock.jumps", "jumps of the sensor's or this machine's clock",
                  status.snapshot->clock.jumps, now_ns);
  look_at_counter("bad_imu_packets", "IMU packets that hold no measurement",
                  status.snapshot->imu.bad_packets, now_ns);
  look_at_mount(status.snapshot->imu);
  look_at_counter("load.shed_scans",
                  "scans of which a part was left out, the machine is too slow (status: load)",
                  status.snapshot->shed_scans[1], now_ns);
  look_at_counter("dropped_keyframes", "keyframes dropped, the back end was too slow",
                  status.snapshot->dropped_keyframes, now_ns);
  look_at_counter("map.unreadable_keyframes",
                  "keyframes of the earlier map that are damaged, it lacks what they showed",
                  status.map->unreadable_keyframes, now_ns);
  look_at_counter("store_failures",
                  "failed writes of the session file (" + status.map->store_error + ")",
                  status.map->store_failures, now_ns);
}

void HealthLog::look_at_refusals(const RuntimeStatus& status, std::uint64_t refused,
                                 std::int64_t now_ns) {
  const std::string why = refused > refused_ ? refusal_sentence(status) : "";
  if (why.empty() || !limiter_.allow("refusal", now_ns)) return;
  spdlog::warn("{}", why);
  refused_ = refused;
}

void HealthLog::look_at_counter(const std::string& name, const std::string& what,
                                std::uint64_t value, std::int64_t now_ns) {
  std::uint64_t& logged = logged_[name];
  if (value <= logged || !limiter_.allow(name, now_ns)) return;
  const std::uint64_t added = value - logged;
  warn_of_counter(fmt::format("{} {} ({} in all)", added, what, value), name, added, value);
  logged = value;
}

void HealthLog::look_at_mount(const ImuStatus& imu) {
  constexpr double kWorthTelling_deg = 5.0;
  if (!imu.up_mps2 || imu.mount_tilt_deg < kWorthTelling_deg || tilt_told_) return;
  tilt_told_ = true;
  spdlog::warn(
      "the sensor's accelerometer says that it is tilted by {:.1f} degrees against "
      "mount.T_base_sensor; correct the mounting, or the map will not be upright",
      imu.mount_tilt_deg);
}

}  // namespace glint::daemon
