// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/network_client.hpp"

#include <fmt/format.h>

#include <utility>

#include "driver/session/sensor_json.hpp"

namespace glint {
namespace {

using nlohmann::json;

constexpr int kNotFound = 404;

std::string way_out(int status) {
  if (status == kNotFound) {
    return "it is no Ouster sensor, or of a firmware that is not known here: check sensor.host";
  }
  if (status >= 500) return "the sensor has a fault: if it stays so, restart the sensor";
  return "the sensor does not take this: correct the setting that it names";
}

/// Old firmware lacks groups of metadata, and says so by a bare sentence or a 4xx.
bool lacks_group(const SensorRequest& request, const ExchangeReply& answer) {
  if (request.group.empty() || !answer.failure.empty()) return false;
  return answer.status == 0 ? answer.body.starts_with("error")
                            : answer.status >= 400 && answer.status < 500;
}

/// Null when the answer is what was asked for.
std::optional<std::string> complaint(const SensorRequest& request, const ExchangeReply& answer,
                                     const std::string& host) {
  if (!answer.failure.empty()) return answer.failure;
  if (lacks_group(request, answer)) return std::nullopt;
  const std::string asked = name_of(request);
  const std::string said = excerpt(answer.body);
  if (answer.status != 0 && (answer.status < 200 || answer.status > 299)) {
    return fmt::format("{} answered {} to {}{}; {}", host, answer.status, asked,
                       said.empty() ? "" : fmt::format(" (\"{}\")", said), way_out(answer.status));
  }
  const bool is_error_line = answer.status == 0 && answer.body.starts_with("error");
  const bool echoes = request.echo.empty() || answer.body == request.echo ||
                      answer.body == '"' + request.echo + '"';
  if (echoes && !is_error_line) return std::nullopt;
  return fmt::format("{} answered \"{}\" to {}; correct the setting that it names", host, said,
                     asked);
}

/// The answer as JSON; null when it is none.
std::optional<json> value_of(const SensorRequest& request, const ExchangeReply& answer) {
  if (lacks_group(request, answer)) return json(excerpt(answer.body));
  const bool is_http = answer.status != 0;
  if (is_http && answer.body.empty()) return json();
  if (auto value = parse_sensor_json(answer.body)) return value;
  // Commands are echoed as they are; of a group that is missing old firmware says some sentence.
  const bool may_be_bare =
      is_http ? !request.echo.empty() : !request.group.empty() || answer.body == name_of(request);
  return may_be_bare ? std::optional(json(excerpt(answer.body))) : std::nullopt;
}

}  // namespace

/// Questions asked one after another, and what has come of them.
// NOLINTNEXTLINE(bugprone-exception-escape): as of SensorReply.
struct NetworkSensorClient::Series {
  std::vector<SensorRequest> requests;
  std::chrono::milliseconds timeout;
  Handler handler;
  std::size_t next = 0;
  SensorReply reply;
};

NetworkSensorClient::NetworkSensorClient(boost::asio::io_context& io, SensorAddress address,
                                         ClientTimeouts timeouts)
    : io_(io), address_(std::move(address)), timeouts_(timeouts) {}

NetworkSensorClient::~NetworkSensorClient() { NetworkSensorClient::cancel(); }

void NetworkSensorClient::cancel() {
  if (exchange_) std::exchange(exchange_, nullptr)->cancel();
}

void NetworkSensorClient::read(SensorResource resource, Handler handler) {
  const bool asks_who = resource == SensorResource::kSensorInfo;
  if (!form_ && asks_who) return identify(std::move(handler));
  if (!form_) {
    SensorReply reply;
    reply.failure = fmt::format("{} has not said its firmware; it is asked again", address_.host);
    return handler(std::move(reply));
  }
  run(read_requests(*form_, resource), timeouts_.read,
      [this, asks_who, handler = std::move(handler)](SensorReply reply) {
        // It may come back with another firmware.
        if (asks_who && !reply.failure.empty()) form_.reset();
        handler(std::move(reply));
      });
}

void NetworkSensorClient::write_config(const json& changes, bool persist, Handler handler) {
  const ApiForm form = form_.value_or(ApiForm::kTcp);
  run(write_requests(form, changes, persist, local_address_), timeouts_.write, std::move(handler));
}

void NetworkSensorClient::identify(Handler handler) {
  const SensorRequest request = firmware_request();
  exchange(request, timeouts_.read, [this, request, handler](const ExchangeReply& answer) {
    const auto failure = complaint(request, answer, address_.host);
    const auto said = failure ? std::nullopt : parse_sensor_json(answer.body);
    const auto firmware = parse_firmware_version(text_member(said.value_or(json()), "fw"));
    form_ = firmware ? std::optional(api_form(*firmware)) : std::nullopt;
    if (form_ && *form_ != ApiForm::kTcp) {
      run(read_requests(*form_, SensorResource::kSensorInfo), timeouts_.read, handler);
      return;
    }
    identify_over_tcp(failure.value_or(fmt::format(
                          "{} answered \"{}\" to {}, which names no firmware; it is no Ouster "
                          "sensor: check sensor.host",
                          address_.host, excerpt(answer.body), name_of(request))),
                      handler);
  });
}

void NetworkSensorClient::identify_over_tcp(const std::string& http_failure, Handler handler) {
  const bool known_old = form_.has_value();
  run(read_requests(ApiForm::kTcp, SensorResource::kSensorInfo), timeouts_.read,
      [this, known_old, http_failure, handler](SensorReply reply) {
        if (reply.failure.empty()) {
          form_ = ApiForm::kTcp;
        } else if (!known_old) {
          // Most sensors have HTTP, so its failure is the one to mend.
          reply.failure = http_failure;
        }
        handler(std::move(reply));
      });
}

void NetworkSensorClient::run(std::vector<SensorRequest> requests,
                              std::chrono::milliseconds timeout, Handler handler) {
  if (requests.empty()) {
    SensorReply reply;
    reply.unsupported = true;
    handler(std::move(reply));
    return;
  }
  const auto series = std::make_shared<Series>();
  series->requests = std::move(requests);
  series->timeout = timeout;
  series->handler = std::move(handler);
  ask_next(series);
}

void NetworkSensorClient::ask_next(const std::shared_ptr<Series>& series) {
  if (series->next == series->requests.size()) {
    series->reply.local_address = local_address_;
    series->reply.sensor_address = sensor_address_;
    series->handler(std::move(series->reply));
    return;
  }
  exchange(series->requests[series->next], series->timeout,
           [this, series](const ExchangeReply& answer) { on_answer(series, answer); });
}

void NetworkSensorClient::on_answer(const std::shared_ptr<Series>& series,
                                    const ExchangeReply& answer) {
  const SensorRequest& request = series->requests[series->next];
  SensorReply& reply = series->reply;
  if (auto failure = complaint(request, answer, address_.host)) {
    reply.failure = std::move(*failure);
    reply.unsupported = answer.status == kNotFound;
    series->handler(std::move(reply));
    return;
  }
  std::optional<json> value = value_of(request, answer);
  if (!value) {
    reply.failure = fmt::format(
        "{} answered \"{}\" to {}, which is not JSON; if it stays so, restart the sensor",
        address_.host, excerpt(answer.body), name_of(request));
    series->handler(std::move(reply));
    return;
  }
  if (request.group.empty()) {
    reply.value = std::move(*value);
  } else {
    reply.value[request.group] = std::move(*value);
  }
  ++series->next;
  ask_next(series);
}

void NetworkSensorClient::exchange(const SensorRequest& request, std::chrono::milliseconds timeout,
                                   Answered answered) {
  const std::uint16_t port = request.method.empty() ? address_.tcp_port : address_.http_port;
  // The exchange is dropped before its answer is looked at, so that the next may start from there.
  exchange_ = start_exchange(io_, {address_.host, port, timeout}, request,
                             [this, answered = std::move(answered)](const ExchangeReply& answer) {
                               exchange_.reset();
                               if (!answer.local_address.empty()) {
                                 local_address_ = answer.local_address;
                                 sensor_address_ = answer.peer_address;
                               }
                               answered(answer);
                             });
}

}  // namespace glint
