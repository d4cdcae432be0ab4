// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/api_form.hpp"

#include <array>
#include <utility>

namespace glint {
namespace {

using nlohmann::json;

constexpr const char* kSensorPath = "/api/v1/sensor/";

constexpr std::array<std::pair<const char*, const char*>, 7> kGroupCommands = {{
    {"sensor_info", "get_sensor_info"},
    {"beam_intrinsics", "get_beam_intrinsics"},
    {"imu_intrinsics", "get_imu_intrinsics"},
    {"lidar_intrinsics", "get_lidar_intrinsics"},
    {"lidar_data_format", "get_lidar_data_format"},
    {"calibration_status", "get_calibration_status"},
    {"config_params", "get_config_param active"},
}};

SensorRequest get(std::string target) { return {"GET", std::move(target), {}, {}, {}}; }
SensorRequest line(std::string text) { return {{}, std::move(text), {}, {}, {}}; }

bool uses_commands(ApiForm form) {
  return form == ApiForm::kCommandGroups || form == ApiForm::kCommands;
}

/// Percent encoding of all but what RFC 3986 calls unreserved.
std::string encode(const std::string& text) {
  constexpr const char* kHex = "0123456789ABCDEF";
  constexpr const char* kUnreserved =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string result;
  for (const char c : text) {
    if (std::string_view(kUnreserved).find(c) != std::string_view::npos) {
      result += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      result += {'%', kHex[byte >> 4U], kHex[byte & 15U]};
    }
  }
  return result;
}

/// A command as HTTP or as a line: "NAME first second" is cmd/NAME?args=first+second.
SensorRequest command(ApiForm form, const std::string& name,
                      const std::vector<std::string>& arguments = {}) {
  if (form == ApiForm::kTcp) {
    std::string text = name;
    for (const std::string& argument : arguments) text += " " + argument;
    return line(std::move(text));
  }
  std::string target = std::string(kSensorPath) + "cmd/" + name;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    target += (i == 0 ? "?args=" : "+") + encode(arguments[i]);
  }
  return get(std::move(target));
}

SensorRequest group_command(ApiForm form, const std::string& words) {
  const auto space = words.find(' ');
  if (space == std::string::npos) return command(form, words);
  return command(form, words.substr(0, space), {words.substr(space + 1)});
}

std::vector<SensorRequest> group_commands(ApiForm form) {
  std::vector<SensorRequest> requests;
  for (const auto& [group, words] : kGroupCommands) {
    requests.push_back(group_command(form, words));
    requests.back().group = group;
  }
  return requests;
}

SensorRequest active_config_request(ApiForm form) {
  if (form == ApiForm::kStaging) return get(std::string(kSensorPath) + "config");
  if (form == ApiForm::kTarget) return get(std::string(kSensorPath) + "config?source=active");
  return command(form, "get_config_param", {"active"});
}

std::vector<SensorRequest> write_commands(ApiForm form, const json& changes, bool persist,
                                          const std::string& local_address) {
  std::vector<SensorRequest> requests;
  for (const auto& [key, value] : changes.items()) {
    std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (text == "@auto" && form != ApiForm::kTcp) {
      requests.push_back(command(form, "set_udp_dest_auto"));
      continue;
    }
    if (text == "@auto") text = local_address;
    requests.push_back(command(form, "set_config_param", {key, std::move(text)}));
    requests.back().echo = "set_config_param";
  }
  requests.push_back(command(form, "reinitialize"));
  if (persist) {
    // Sensors of the TCP era know the older name only.
    const bool old = form == ApiForm::kTcp;
    requests.push_back(command(form, old ? "write_config_txt" : "save_config_params"));
  }
  return requests;
}

}  // namespace

ApiForm api_form(FirmwareVersion firmware) {
  if (firmware < FirmwareVersion{2, 1}) return ApiForm::kTcp;
  if (firmware < FirmwareVersion{2, 2}) return ApiForm::kCommandGroups;
  if (firmware < FirmwareVersion{3, 1}) return ApiForm::kCommands;
  if (firmware < FirmwareVersion{4, 0}) return ApiForm::kStaging;
  return ApiForm::kTarget;
}

std::string name_of(const SensorRequest& request) {
  if (request.method.empty()) return request.target.substr(0, request.target.find(' '));
  return request.method + " " + request.target;
}

SensorRequest firmware_request() { return get("/api/v1/system/firmware"); }

std::vector<SensorRequest> read_requests(ApiForm form, SensorResource resource) {
  const bool tcp = form == ApiForm::kTcp;
  const bool by_group = tcp || form == ApiForm::kCommandGroups;
  switch (resource) {
    case SensorResource::kSensorInfo:
      if (by_group) return {command(form, "get_sensor_info")};
      return {get(std::string(kSensorPath) + "metadata/sensor_info")};
    case SensorResource::kMetadata:
      if (by_group) return group_commands(form);
      return {get(std::string(kSensorPath) + "metadata")};
    case SensorResource::kActiveConfig:
      return {active_config_request(form)};
    case SensorResource::kAlerts:
      if (tcp) return {line("get_alerts")};
      return {get(std::string(kSensorPath) + "alerts")};
    case SensorResource::kTelemetry:
      if (tcp) return {};
      return {get(std::string(kSensorPath) + "telemetry")};
    case SensorResource::kPtp:
      if (tcp) return {};
      return {get("/api/v1/time/ptp")};
    case SensorResource::kTime:
      if (tcp) return {line("get_time_info")};
      return {get("/api/v1/time/sensor")};
  }
  return {};
}

std::vector<SensorRequest> write_requests(ApiForm form, const json& changes, bool persist,
                                          const std::string& local_address) {
  if (form == ApiForm::kTcp || uses_commands(form)) {
    return write_commands(form, changes, persist, local_address);
  }
  std::string target = std::string(kSensorPath) + "config?";
  if (form == ApiForm::kStaging) {
    target += std::string("staging=false&reinit=true&persist=") + (persist ? "true" : "false");
  } else {
    // Always named: the sensor's own default is its flash.
    target += persist ? "target=active_persisted" : "target=active";
  }
  return {{"POST", std::move(target), changes.dump(), {}, {}}};
}

}  // namespace glint
