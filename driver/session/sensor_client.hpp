// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace glint {

/// What can be read of a sensor.
enum class SensorResource {
  kSensorInfo,    ///< Serial number, firmware, status, initialization id.
  kMetadata,      ///< All groups, as parse_sensor_info() reads them.
  kActiveConfig,  ///< The settings in force.
  kAlerts,
  kTelemetry,
  kPtp,
  kTime,
};

/// Answer to one question. Value type.
// NOLINTNEXTLINE(bugprone-exception-escape): only an assertion of nlohmann's could throw.
struct SensorReply {
  nlohmann::json value;  ///< Of a read. Untrusted: may be of any type.
  /// One sentence that names the host, what was asked and the way out; empty when all went well.
  std::string failure;
  bool unsupported = false;    ///< This firmware has no such thing.
  std::string local_address;   ///< Of this machine, as the sensor sees it; may be empty.
  std::string sensor_address;  ///< Of the sensor, an IP address; may be empty.
};

/// How a sensor is talked to. Each call answers exactly once, within a bounded time, unless it is
/// cancelled; one call at a time. Thread-compatible; answers come on the thread that runs it.
class SensorClient {
 public:
  using Handler = std::function<void(SensorReply)>;

  virtual ~SensorClient() = default;

  /// Asks for something. kSensorInfo comes first: by it the client learns how to ask for the rest.
  virtual void read(SensorResource resource, Handler handler) = 0;
  /// Sets some settings (an object of keys and values, "@auto" as udp_dest being this machine) and
  /// has the sensor reinitialise with them. They last until it loses power, or, with `persist`, are
  /// kept in its flash.
  virtual void write_config(const nlohmann::json& changes, bool persist, Handler handler) = 0;
  /// Drops what is under way: its handler will not be called.
  virtual void cancel() = 0;
};

}  // namespace glint
