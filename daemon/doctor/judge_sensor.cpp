// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "daemon/doctor/judgement.hpp"

namespace glint::daemon {
namespace {

Finding judge_status(const SensorFacts& sensor) {
  if (sensor.status == "RUNNING") return ok("status", "the sensor is RUNNING");
  if (sensor.status == "STANDBY" || sensor.operating_mode == "STANDBY") {
    return {FindingLevel::kFail, "status", "the sensor is in STANDBY and sends nothing",
            "glintd: sensor.operating_mode = \"NORMAL\"; or glint record --configure"};
  }
  if (sensor.status == "INITIALIZING" || sensor.status == "WARMUP" || sensor.status == "UPDATING") {
    return {FindingLevel::kWarn, "status", fmt::format("the sensor is {}", sensor.status),
            "wait a minute and look again"};
  }
  if (sensor.status.empty()) {
    return {FindingLevel::kWarn, "status", "the sensor does not tell its status", "look again"};
  }
  return {FindingLevel::kFail, "status", fmt::format("the sensor is {}", sensor.status),
          "read its alerts below; if there are none, cut its power for ten seconds"};
}

bool is_multicast(const std::string& address) {
  const bool v6 = address.starts_with("ff") && address.find(':') != std::string::npos;
  const int first = v6 ? 0 : std::atoi(address.c_str());
  return v6 || (first >= 224 && first <= 239);
}

Finding judge_destination(const SensorFacts& sensor, const HostFacts& host) {
  const std::string step = "destination";
  const std::string mend = "glintd: sensor.configure = true; or glint record --configure";
  const std::string& to = sensor.udp_dest;
  if (to.empty()) return {FindingLevel::kFail, step, "the sensor has no udp_dest", mend};
  if (is_multicast(to)) {
    return ok(step, fmt::format("the sensor sends to the multicast group {}", to));
  }
  const bool ours = std::ranges::find(host.own_addresses, to) != host.own_addresses.end();
  if (ours || to == "255.255.255.255") {
    return ok(step, fmt::format("the sensor sends to this machine ({})", to));
  }
  return {FindingLevel::kFail, step, fmt::format("the sensor sends to {}, not to this machine", to),
          mend};
}

Finding judge_metadata(const SensorFacts& sensor) {
  if (sensor.info) {
    return ok("metadata", fmt::format("{} {}, {}, profile {}", sensor.info->product_line,
                                      sensor.info->serial_number, sensor.info->lidar_mode,
                                      to_string(sensor.info->profile)));
  }
  return {FindingLevel::kFail, "metadata", sensor.info_failure,
          "update the sensor's firmware, or report this with its metadata"};
}

Findings judge_alerts(const SensorFacts& sensor) {
  if (sensor.alerts.empty()) return {ok("alerts", "none is active")};
  Findings findings;
  for (const SensorAlert& alert : sensor.alerts) {
    const bool unreachable = alert.id == kLidarUnreachableAlert || alert.id == kImuUnreachableAlert;
    findings.push_back({unreachable ? FindingLevel::kFail : FindingLevel::kWarn, "alerts",
                        fmt::format("{} {}: {}", alert.id, alert.category, alert.message),
                        unreachable ? "connect this machine to the sensor's network, and check "
                                      "udp_dest"
                                    : "see this alert in the sensor's manual"});
  }
  return findings;
}

Finding judge_clock(const SensorFacts& sensor) {
  const std::string step = "clock";
  if (sensor.timestamp_mode == "TIME_FROM_PTP_1588") {
    if (!sensor.ptp) {
      return {FindingLevel::kWarn, step, "times are from PTP, of which the sensor says nothing",
              "check the PTP master on its network"};
    }
    if (sensor.ptp->locked) {
      return ok(step, fmt::format("PTP follows {}, {} ns off", sensor.ptp->grandmaster,
                                  sensor.ptp->offset_ns.value_or(0.0)));
    }
    return {FindingLevel::kWarn, step,
            fmt::format("times are from PTP, but the sensor follows no master ({})",
                        sensor.ptp->port_state),
            "ptp4l -i INTERFACE -m on this machine, or another master on its network"};
  }
  if (sensor.timestamp_mode == "TIME_FROM_SYNC_PULSE_IN" && sensor.time &&
      sensor.time->sync_pulse_locked == false) {
    return {FindingLevel::kWarn, step, "times are from a sync pulse, but there is none",
            "check the pulse's wire, sync_pulse_in_polarity and multipurpose_io_mode"};
  }
  return ok(step,
            fmt::format("times are by {}", sensor.timestamp_mode.empty() ? "the sensor's own clock"
                                                                         : sensor.timestamp_mode));
}

}  // namespace

Finding judge_route(const RouteLookup& lookup, const DoctorWishes& wishes) {
  if (lookup.route) {
    const Route& route = *lookup.route;
    return ok("route",
              fmt::format("{} is reached through {} as {}", route.address,
                          route.interface.empty() ? "an interface without a name" : route.interface,
                          route.local_address));
  }
  return {FindingLevel::kFail, "route", lookup.failure,
          fmt::format("check the cable and the name {}, and give the interface an address of the "
                      "sensor's network: ip address add 10.5.5.1/24 dev INTERFACE",
                      wishes.sensor)};
}

Findings judge_sensor(const SensorFacts& sensor, const HostFacts& host,
                      const DoctorWishes& wishes) {
  if (!sensor.failure.empty()) {
    return {{FindingLevel::kFail, "interface", sensor.failure,
             fmt::format("check that it has power and a link: ping {}", wishes.sensor)}};
  }
  Findings findings;
  findings.push_back(ok("interface", fmt::format("{} {} answers, firmware {}", sensor.product_line,
                                                 sensor.serial_number, sensor.firmware)));
  findings.push_back(judge_status(sensor));
  findings.push_back(judge_destination(sensor, host));
  findings.push_back(judge_metadata(sensor));
  std::ranges::move(judge_alerts(sensor), std::back_inserter(findings));
  findings.push_back(judge_clock(sensor));
  return findings;
}

}  // namespace glint::daemon
