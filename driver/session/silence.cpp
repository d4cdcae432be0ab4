// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/silence.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>

#include "driver/session/sensor_json.hpp"

namespace glint {
namespace {

bool is_multicast(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  return !error && parsed.is_multicast();
}

}  // namespace

std::string why_no_packets(const SessionStatus& status, const nlohmann::json& active_config,
                           const std::string& local_address) {
  const std::string& host = status.host;
  if (status.sensor_status == "STANDBY") {
    return fmt::format("{} is in standby; set its operating_mode to NORMAL", host);
  }
  if (status.sensor_status == "ERROR" && !status.health.alerts.empty()) {
    const SensorAlert& alert = status.health.alerts.front();
    return fmt::format("{} reports the error {} {} ({}); restart it", host, alert.id,
                       alert.category, alert.message);
  }
  const std::string& dest = status.udp_dest;
  const std::int64_t port = integer_member(active_config, "udp_port_lidar").value_or(0);
  for (const SensorAlert& alert : status.health.alerts) {
    if (alert.id != kLidarUnreachableAlert && alert.id != kImuUnreachableAlert) continue;
    return fmt::format(
        "{} cannot reach {}, where it sends its packets (its alert {}); set its "
        "udp_dest to {}",
        host, dest, alert.id, local_address);
  }
  if (is_multicast(dest)) {
    return fmt::format(
        "no packets of {} although it sends them to the group {}, to UDP port {}; join that group, "
        "and open the port in the firewall of this machine",
        host, dest, port);
  }
  if (dest != local_address && !local_address.empty()) {
    return fmt::format(
        "no packets of {}: it sends them to {}, and this machine is {}; let "
        "udp_dest be @auto",
        host, dest.empty() ? "nowhere" : dest, local_address);
  }
  return fmt::format(
      "no packets of {} although it sends them here, to UDP port {}; open that port "
      "in the firewall of this machine",
      host, port);
}

}  // namespace glint
