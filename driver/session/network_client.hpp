// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/session/api_form.hpp"
#include "driver/session/exchange.hpp"
#include "driver/session/sensor_address.hpp"
#include "driver/session/sensor_client.hpp"

namespace glint {

/// How long a sensor may take.
struct ClientTimeouts {
  std::chrono::milliseconds read{4000};
  std::chrono::milliseconds write{40'000};  ///< Some firmware answers when it has reinitialised.
};

/// A sensor on the network: over HTTP in the form of its firmware, or by the text commands of its
/// TCP port when it has no usable HTTP. Reading kSensorInfo finds out which, and again after it has
/// failed.
/// Thread-compatible: used on the thread that runs the io_context.
class NetworkSensorClient final : public SensorClient {
 public:
  NetworkSensorClient(boost::asio::io_context& io, SensorAddress address, ClientTimeouts timeouts);
  ~NetworkSensorClient() override;
  NetworkSensorClient(const NetworkSensorClient&) = delete;
  NetworkSensorClient& operator=(const NetworkSensorClient&) = delete;

  void read(SensorResource resource, Handler handler) override;
  void write_config(const nlohmann::json& changes, bool persist, Handler handler) override;
  void cancel() override;

  /// How the sensor is talked to; null before it has said its firmware.
  [[nodiscard]] std::optional<ApiForm> form() const { return form_; }

 private:
  struct Series;
  using Answered = std::function<void(const ExchangeReply&)>;

  void identify(Handler handler);
  void identify_over_tcp(const std::string& http_failure, Handler handler);
  void run(std::vector<SensorRequest> requests, std::chrono::milliseconds timeout, Handler handler);
  void ask_next(const std::shared_ptr<Series>& series);
  void on_answer(const std::shared_ptr<Series>& series, const ExchangeReply& answer);
  void exchange(const SensorRequest& request, std::chrono::milliseconds timeout, Answered answered);

  boost::asio::io_context& io_;
  const SensorAddress address_;
  const ClientTimeouts timeouts_;
  std::optional<ApiForm> form_;
  std::string local_address_;
  std::string sensor_address_;
  std::shared_ptr<Exchange> exchange_;  ///< The one under way.
};

}  // namespace glint
