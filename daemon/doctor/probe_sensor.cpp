// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <boost/asio/io_context.hpp>
#include <chrono>

#include "daemon/doctor/probes.hpp"
#include "driver/core/error.hpp"
#include "driver/session/network_client.hpp"
#include "driver/session/sensor_json.hpp"

namespace glint::daemon {
namespace {

/// Questions asked one after the other.
class Interview {
 public:
  explicit Interview(const std::string& host)
      : client_(io_, parse_sensor_address(host),
                {std::chrono::seconds(4), std::chrono::seconds(4)}) {}

  SensorReply ask(SensorResource resource) {
    SensorReply answer;
    client_.read(resource, [&](SensorReply reply) { answer = std::move(reply); });
    io_.restart();
    io_.run();
    return answer;
  }

 private:
  boost::asio::io_context io_{1};
  NetworkSensorClient client_;
};

void take_metadata(const SensorReply& reply, const std::string& host, SensorFacts& facts) {
  facts.info_failure = reply.failure;
  if (!reply.failure.empty()) return;
  try {
    facts.info = parse_sensor_info(reply.value.dump(), host);
  } catch (const InputError& error) {
    facts.info_failure = error.what();
  }
}

}  // namespace

SensorFacts look_at_sensor(const std::string& host) {
  Interview sensor(host);
  SensorFacts facts;
  const SensorReply info = sensor.ask(SensorResource::kSensorInfo);
  facts.failure = info.failure;
  if (!facts.failure.empty()) return facts;
  facts.product_line = excerpt(text_member(info.value, "prod_line"));
  facts.serial_number = excerpt(text_member(info.value, "prod_sn"));
  facts.firmware = excerpt(text_member(info.value, "build_rev"));
  facts.status = excerpt(text_member(info.value, "status"));
  const SensorReply config = sensor.ask(SensorResource::kActiveConfig);
  facts.udp_dest = excerpt(text_member(config.value, "udp_dest"));
  if (facts.udp_dest.empty()) facts.udp_dest = excerpt(text_member(config.value, "udp_ip"));
  facts.operating_mode = excerpt(text_member(config.value, "operating_mode"));
  facts.timestamp_mode = excerpt(text_member(config.value, "timestamp_mode"));
  take_metadata(sensor.ask(SensorResource::kMetadata), host, facts);
  // What a firmware does not tell stays unknown.
  const SensorReply alerts = sensor.ask(SensorResource::kAlerts);
  if (alerts.failure.empty()) facts.alerts = parse_alerts(alerts.value);
  const SensorReply ptp = sensor.ask(SensorResource::kPtp);
  if (ptp.failure.empty()) facts.ptp = parse_ptp(ptp.value);
  const SensorReply time = sensor.ask(SensorResource::kTime);
  if (time.failure.empty()) facts.time = parse_time(time.value);
  return facts;
}

}  // namespace glint::daemon
