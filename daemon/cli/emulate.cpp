// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint emulate: a capture's packets on the wire, as the sensor sent them.
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <memory>

#include "daemon/cli/capture_input.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/udp_sender.hpp"
#include "daemon/host_port.hpp"
#include "daemon/replay_pacer.hpp"
#include "daemon/steady_clock.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

struct EmulateOptions {
  CaptureInput input;
  std::string to;
  std::string rate = "1";
  int imu_port = 0;  ///< 0: the lidar port + 1.
  int loops = 1;
};

struct Sent {
  std::uint64_t lidar = 0;
  std::uint64_t imu = 0;
};

/// Sends the capture once.
void send_capture(PacketSource& source, std::size_t imu_bytes, const UdpSender& lidar,
                  const UdpSender& imu, Sent& sent) {
  RawPacket packet;
  SourceStatus status = source.read(packet);
  for (; status != SourceStatus::kEnd; status = source.read(packet)) {
    if (status == SourceStatus::kIdle) continue;
    const bool is_imu = packet.bytes.size() == imu_bytes;
    (is_imu ? imu : lidar).send(packet.bytes);
    ++(is_imu ? sent.imu : sent.lidar);
  }
}

void emulate(const EmulateOptions& options) {
  const auto target = daemon::parse_host_port(options.to);
  if (!target || target->port == 0) {
    throw UsageError(
        fmt::format("--to {} is not HOST:PORT; write e.g. 127.0.0.1:7502 or "
                    "[::1]:7502.",
                    options.to));
  }
  const int imu_port = options.imu_port != 0 ? options.imu_port : target->port + 1;
  if (imu_port > 65535) throw UsageError("There is no port after 65535; name one with --imu-port.");
  const SensorInfo info = load_capture_info(options.input);
  const UdpSender lidar(target->host, target->port);
  const UdpSender imu(target->host, static_cast<std::uint16_t>(imu_port));

  const std::optional<double> rate = daemon::parse_rate(options.rate);
  daemon::ReplayPacer pacer(rate.value_or(1.0));
  Pacer wait;
  if (rate) wait = [&pacer](HostTime time) { return pacer.wait(time); };

  Sent sent;
  const std::int64_t start_ns = daemon::steady_now_ns();
  for (int loop = 0; loop < options.loops; ++loop) {
    const auto source = open_capture(options.input, info, wait);
    pacer.restart();
    send_capture(*source, PacketFormat(info).imu_packet_bytes, lidar, imu, sent);
    if (loop == 0) print_notices(source->notices());
  }
  const double seconds = static_cast<double>(daemon::steady_now_ns() - start_ns) * kSecondsPerNs;
  std::cout << fmt::format(
      "sent {} lidar packets to port {} and {} IMU packets to port {} of {} in {:.3f} s\n",
      sent.lidar, target->port, sent.imu, imu_port, target->host, seconds);
}

/// CLI11 wants the complaint as a string, empty for none.
std::string check_rate(const std::string& text) {
  try {
    static_cast<void>(daemon::parse_rate(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

void add_emulate(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("emulate", "Send a capture's packets over UDP, as its sensor did");
  const auto options = std::make_shared<EmulateOptions>();
  add_capture_options(*command, options->input);
  command->add_option("--to", options->to, "HOST:PORT that lidar packets go to")->required();
  command->add_option("--rate", options->rate, "Speed: 1 as recorded, 2 twice as fast, or max")
      ->check(check_rate)
      ->capture_default_str();
  command->add_option("--imu-port", options->imu_port, "Port for IMU packets; default PORT + 1")
      ->check(CLI::Range(1, 65535));
  command->add_option("--loop", options->loops, "Times to send the capture")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback([options] { emulate(*options); });
}

}  // namespace glint::cli
