// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/sensor_link.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>

#include "daemon/sensor_change.hpp"
#include "daemon/steady_clock.hpp"

namespace glint::daemon {
namespace {

constexpr std::size_t kMostTold = 100;

bool same_family(const std::string& a, const std::string& b) {
  boost::system::error_code no_a;
  boost::system::error_code no_b;
  const auto address_a = boost::asio::ip::make_address(a, no_a);
  const auto address_b = boost::asio::ip::make_address(b, no_b);
  return !no_a && !no_b && address_a.is_v4() == address_b.is_v4();
}

}  // namespace

SensorLink::SensorLink(boost::asio::io_context& io, Runtime& runtime,
                       const SensorLinkOptions& options)
    : runtime_(runtime),
      options_(options),
      client_(io, options.address, options.timeouts),
      session_(client_, options.session, [this] { return activity(); },
               {[this](const std::string& json) { on_metadata(json); },
                [this](SessionState state, const std::string& text) { on_news(state, text); }}),
      runner_(io, session_, stage_clock()) {}

PacketActivity SensorLink::activity() const {
  const LastPacket last = runtime_.last_packet();
  return {last.arrival_ns, last.init_id};
}

void SensorLink::on_news(SessionState state, const std::string& sentence) {
  const SessionStatus& status = session_.status();
  const bool failed = sentence == status.failure;
  runtime_.events().post(
      {"sensor", 0, Json{{"state", to_string(state)}, {"failed", failed}, {"message", sentence}}});
  if (!is_worth_a_line(state, sentence)) return;
  if (failed) {
    spdlog::warn("sensor: {} (failure {}; it is tried again)", sentence, status.failures);
  } else {
    spdlog::info("sensor: {}: {}", to_string(state), sentence);
  }
}

bool SensorLink::is_worth_a_line(SessionState state, const std::string& sentence) {
  // Attempts that fail again and again, for days perhaps, take the same steps each time.
  if (state == SessionState::kRunning || told_.size() > kMostTold) told_.clear();
  if (!told_.insert(sentence).second) return false;
  // A stall names its length, and is the same cause whatever it is.
  return limiter_.allow(state == SessionState::kStalled ? "stall" : sentence, steady_now_ns());
}

void SensorLink::on_metadata(const std::string& json) {
  filter_source();
  for (const std::string& setting : status().unmet) {
    tell(fmt::format("{} took a setting and yet does not report it: {}", status().host, setting));
  }
  problem_.clear();
  try {
    const SensorInfo info = parse_sensor_info(json, status().host);
    problem_ = mismatch(info);
    if (options_.take_metadata) use(info);
    session_.set_stall_ns(std::max(options_.session.times.stall_ns, runtime_.silence_ns()));
  } catch (const MetadataError& error) {
    problem_ = error.what();
  }
  if (!problem_.empty()) tell(problem_);
}

std::string SensorLink::mismatch(const SensorInfo& info) const {
  if (info.lidar_port != options_.ports.lidar) {
    return fmt::format(
        "{} sends its lidar packets to port {}, and port {} is listened on; set sensor.lidar_port "
        "= {}, or sensor.configure = true",
        status().host, info.lidar_port, options_.ports.lidar, info.lidar_port);
  }
  const auto known = runtime_.sensor();
  if (options_.take_metadata || known == nullptr) return {};
  const std::string change = stream_change(*known, info);
  if (known->serial_number == info.serial_number && change.empty()) return {};
  return fmt::format(
      "the metadata file is of the sensor {}, {} is {}{}; leave sensor.metadata_file and --meta "
      "out, and it is read from the sensor",
      known->serial_number, status().host, info.serial_number,
      change.empty() ? "" : fmt::format(" ({})", change));
}

void SensorLink::use(const SensorInfo& info) {
  const auto before = runtime_.sensor();
  runtime_.use_sensor(info, true);
  for (const std::string& warning : info.warnings) tell(warning);
  const std::string change = before ? stream_change(*before, info) : "";
  if (!before) {
    spdlog::info("sensor: {} {}, {} beams, {}, {}", info.product_line, info.serial_number,
                 info.pixels_per_column, info.lidar_mode, to_string(info.profile));
  } else if (!change.empty()) {
    const std::string sentence =
        fmt::format("{} comes back with {}: tracking restarts in a new segment, the map is kept",
                    status().host, change);
    spdlog::info("sensor: {}", sentence);
    runtime_.events().post(
        {"sensor", 0, Json{{"state", to_string(status().state)}, {"message", sentence}}});
  }
}

void SensorLink::filter_source() {
  const std::string& address = status().address;
  // A sensor that answers over one family may well send over the other.
  const bool known = same_family(address, status().udp_dest);
  if (!options_.filter_source || !known || address == filtered_address_) return;
  filtered_address_ = address;
  runtime_.set_source_address(address);
  spdlog::info("sensor: packets are taken from {} only (sensor.source_address)", address);
}

void SensorLink::tell(const std::string& sentence) {
  if (limiter_.allow(sentence, steady_now_ns())) spdlog::warn("sensor: {}", sentence);
}

}  // namespace glint::daemon
