// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/session/firmware_version.hpp"
#include "driver/session/sensor_client.hpp"

namespace glint {

/// The generations of the sensor's interface.
enum class ApiForm {
  kTcp,            ///< Before 2.1: text commands on TCP port 7501 (2.0 has HTTP, but unreliable).
  kCommandGroups,  ///< 2.1: commands over HTTP, metadata group by group.
  kCommands,       ///< 2.2 to 3.0: commands over HTTP, metadata at once.
  kStaging,        ///< 3.1 to 3.x: POST config?staging=&reinit=&persist=.
  kTarget,         ///< 4.x: POST config?target=.
};

ApiForm api_form(FirmwareVersion firmware);

/// One question to a sensor. Value type.
struct SensorRequest {
  std::string method;  ///< "GET", "POST"; empty for a line of text on the TCP port.
  std::string target;  ///< Path and query, or the line.
  std::string body;    ///< JSON, or empty.
  std::string group;   ///< The answer goes under this key of the result; empty: it is the result.
  std::string echo;    ///< The answer must be this JSON string or bare word; empty: any.
};

/// "GET /api/v1/...", or the line's first word.
std::string name_of(const SensorRequest& request);

/// What a sensor is asked for its firmware before its form is known.
SensorRequest firmware_request();
/// The questions whose answers make up a resource; none when the form does not have it.
std::vector<SensorRequest> read_requests(ApiForm form, SensorResource resource);
/// The commands that apply `changes` (an object of settings) and reinitialise, in order. Nothing is
/// written to flash unless `persist`. `local_address` stands for "@auto" where a form lacks that.
std::vector<SensorRequest> write_requests(ApiForm form, const nlohmann::json& changes, bool persist,
                                          const std::string& local_address);

}  // namespace glint
