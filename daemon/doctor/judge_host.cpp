// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "daemon/doctor/judgement.hpp"
#include "driver/core/gravity.hpp"
#include "driver/core/imu_packet_layout.hpp"
#include "driver/core/packet_format.hpp"

namespace glint::daemon {
namespace {

// An IMU of this kind is off by some 0.05 m/s^2; more is a broken unit, or other units.
constexpr double kGravityTolerance_mps2 = 0.5;
constexpr double kMountTolerance_deg = 10.0;

/// What was added during the look; null when it cannot be told.
std::optional<std::uint64_t> growth(const std::optional<std::uint64_t>& before,
                                    const std::optional<std::uint64_t>& after) {
  if (!before || !after || *after < *before) return std::nullopt;
  return *after - *before;
}

Finding judge_rmem(const HostFacts& host, const DoctorWishes& wishes) {
  const std::string step = "receive buffer";
  if (!host.rmem_max_bytes) {
    return {FindingLevel::kWarn, step, "net.core.rmem_max cannot be read", "run outside a sandbox"};
  }
  if (*host.rmem_max_bytes >= wishes.rcvbuf_bytes) {
    return ok(step, fmt::format("net.core.rmem_max is {}, {} are asked for", *host.rmem_max_bytes,
                                wishes.rcvbuf_bytes));
  }
  return {FindingLevel::kWarn, step,
          fmt::format("net.core.rmem_max is {}, so the kernel grants less than the {} bytes of "
                      "sensor.rcvbuf_bytes",
                      *host.rmem_max_bytes, wishes.rcvbuf_bytes),
          fmt::format("sysctl -w net.core.rmem_max={}", wishes.rcvbuf_bytes)};
}

Finding judge_receive_errors(const HostFacts& host) {
  const auto& total = host.after.receive_buffer_errors;
  const auto grown = growth(host.before.receive_buffer_errors, total);
  if (grown && *grown > 0) {
    return {FindingLevel::kWarn, "kernel drops",
            fmt::format("{} datagrams found no room in a receive buffer while this looked", *grown),
            "sysctl -w net.core.rmem_max=26214400, raise sensor.rcvbuf_bytes, free the processor"};
  }
  return ok("kernel drops",
            total ? fmt::format("none now; {} since this machine started", *total) : "not counted");
}

Finding judge_reassembly(const HostFacts& host) {
  const auto& total = host.after.reassembly_failures;
  const auto grown = growth(host.before.reassembly_failures, total);
  if (grown && *grown > 0) {
    const std::int64_t high = host.ipfrag_high_bytes.value_or(0);
    return {FindingLevel::kWarn, "reassembly",
            fmt::format("{} datagrams could not be put together from their fragments while this "
                        "looked: fragments get lost on the way",
                        *grown),
            fmt::format("check cable and switch; sysctl -w net.ipv4.ipfrag_high_thresh={}",
                        std::max<std::int64_t>(2 * high, 26'214'400))};
  }
  return ok("reassembly", total ? fmt::format("no failure now; {} since this machine started; "
                                              "net.ipv4.ipfrag_high_thresh is {}",
                                              *total, host.ipfrag_high_bytes.value_or(0))
                                : "not counted");
}

/// Why nothing came through, with what is known of the way.
Finding judge_silence(const PacketFacts& packets, const HostFacts& host, const SensorFacts& sensor,
                      const RouteLookup& route) {
  const std::string step = "packets";
  if (packets.on_wire.value_or(0) > 0) {
    if (host.rp_filter == 1) {
      return {FindingLevel::kFail, step,
              fmt::format("{} packets are on the wire and none gets through: strict reverse path "
                          "filter or firewall",
                          *packets.on_wire),
              fmt::format("sysctl -w net.ipv4.conf.{}.rp_filter=2, and let UDP in",
                          route.route ? route.route->interface : "all")};
    }
    return {FindingLevel::kFail, step,
            fmt::format("{} packets are on the wire and none gets through: a firewall drops them",
                        *packets.on_wire),
            "nft add rule inet filter input udp dport { 7502, 7503 } accept"};
  }
  const std::string seen = packets.on_wire ? "neither on the wire nor in the socket"
                                           : "in the socket (run as root to look at the wire too)";
  const bool sends = sensor.failure.empty() && sensor.status == "RUNNING";
  return {sends ? FindingLevel::kFail : FindingLevel::kWarn, step,
          fmt::format("no packet in {:.1f} s {}", packets.seconds, seen),
          sends ? "check udp_dest and udp_port_lidar above, cable, switch and firewall"
                : "name the sensor with --sensor HOST to have it asked"};
}

}  // namespace

Findings judge_ports(const HostFacts& host) {
  Findings findings;
  for (const PortFacts& port : host.ports) {
    if (!port.held) {
      findings.push_back(ok("ports", fmt::format("port {} is free", port.port)));
    } else if (port.holder.starts_with("glintd ")) {
      findings.push_back(ok("ports", fmt::format("port {} is held by {}", port.port, port.holder)));
    } else {
      const std::string who = port.holder.empty() ? "another program" : port.holder;
      findings.push_back({FindingLevel::kFail, "ports",
                          fmt::format("port {} is held by {}", port.port, who),
                          fmt::format("stop it (ss -ulnp sport = :{}), or choose another port with "
                                      "sensor.lidar_port and sensor.imu_port",
                                      port.port)});
    }
  }
  return findings;
}

Findings judge_packets(const PacketFacts& packets, const HostFacts& host, const SensorFacts& sensor,
                       const RouteLookup& route) {
  if (!packets.listened) {
    if (!packets.on_wire) return {};  // The port's finding has said why.
    return {ok("packets", fmt::format("{} on the wire in {:.1f} s, for the program that holds the "
                                      "ports",
                                      *packets.on_wire, packets.seconds))};
  }
  if (packets.lidar > 0) {
    return {ok("packets", fmt::format("{:.0f} lidar and {:.0f} IMU packets a second",
                                      static_cast<double>(packets.lidar) / packets.seconds,
                                      static_cast<double>(packets.imu) / packets.seconds))};
  }
  if (packets.imu > 0) {
    return {{FindingLevel::kFail, "packets",
             fmt::format("{} IMU packets came in {:.1f} s and no lidar packet: fragments of large "
                         "packets are lost on the way",
                         packets.imu, packets.seconds),
             "check the MTU on the way, and that no firewall drops fragments"}};
  }
  if (packets.other > 0 && sensor.info) {
    return {{FindingLevel::kFail, "packets",
             fmt::format("packets have {} bytes, those of the sensor's settings have {}",
                         packets.other_bytes, PacketFormat(*sensor.info).packet_bytes),
             "let no other sensor send to these ports, or name this one's with "
             "sensor.source_address"}};
  }
  if (packets.other > 0) {
    return {ok("packets", fmt::format("{:.0f} a second, the largest of {} bytes",
                                      static_cast<double>(packets.other) / packets.seconds,
                                      packets.other_bytes))};
  }
  return {judge_silence(packets, host, sensor, route)};
}

Findings judge_buffers(const HostFacts& host, const DoctorWishes& wishes) {
  return {judge_rmem(host, wishes), judge_receive_errors(host), judge_reassembly(host)};
}

Findings judge_fragments(const RouteLookup& route, const SensorFacts& sensor) {
  if (!route.route || route.route->mtu <= 0 || !sensor.info) return {};
  constexpr int kIpAndUdpHeaders = 28;
  constexpr int kIpHeader = 20;
  const int mtu = route.route->mtu;
  const auto bytes = static_cast<int>(PacketFormat(*sensor.info).packet_bytes);
  const std::string& interface = route.route->interface;
  if (bytes + kIpAndUdpHeaders <= mtu) {
    return {
        ok("MTU", fmt::format("packets of {} bytes fit the MTU {} of {}", bytes, mtu, interface))};
  }
  const int step = (mtu - kIpHeader) / 8 * 8;
  const int fragments = (bytes + kIpAndUdpHeaders - kIpHeader + step - 1) / step;
  return {
      {FindingLevel::kWarn, "MTU",
       fmt::format("packets of {} bytes come in {} fragments at MTU {} of {}; one lost fragment "
                   "loses them all",
                   bytes, fragments, mtu, interface),
       fmt::format("if sensor and switch allow: ip link set {} mtu 9000; else the low data rate "
                   "profile: sensor.udp_profile_lidar = \"RNG15_RFL8_NIR8\"",
                   interface)}};
}

Findings judge_gravity(const PacketFacts& packets, const DoctorWishes& wishes) {
  const std::string step = "gravity";
  if (packets.imu == 0) return {};
  if (!packets.up_mps2) {
    return {ok(step, "the sensor did not rest, so gravity was not compared with its mounting")};
  }
  const double size = packets.up_mps2->norm();
  if (std::abs(size - kStandardGravity_mps2) > kGravityTolerance_mps2) {
    return {{FindingLevel::kWarn, step,
             fmt::format("at rest the IMU measures {:.2f} m/s^2 in place of 9.81", size),
             "take metadata of this sensor and firmware; if they are, the IMU is broken"}};
  }
  const double tilt_deg = mount_tilt_deg(*packets.up_mps2, wishes.T_base_sensor.rotation);
  if (tilt_deg <= kMountTolerance_deg) {
    return {ok(step, fmt::format("{:.2f} m/s^2, {:.1f} degrees off base's z axis by "
                                 "mount.T_base_sensor",
                                 size, tilt_deg))};
  }
  return {
      {FindingLevel::kWarn, step,
       fmt::format("gravity is {:.0f} degrees off base's z axis by mount.T_base_sensor", tilt_deg),
       "correct the rotation of mount.T_base_sensor, unless the robot stands on a slope"}};
}

}  // namespace glint::daemon
