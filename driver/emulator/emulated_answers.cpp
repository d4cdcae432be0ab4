// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What an emulated sensor answers, by path and by command.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "driver/core/error.hpp"
#include "driver/core/time.hpp"
#include "driver/emulator/emulated_sensor.hpp"
#include "driver/session/sensor_json.hpp"

namespace glint::emulator {
namespace {

using nlohmann::json;

EmulatedAnswer ok(const json& value) { return {200, value.dump()}; }
EmulatedAnswer bad_request(const std::string& why) { return {400, json{{"error", why}}.dump()}; }
EmulatedAnswer not_found() { return {404, json{{"error", "not found"}}.dump()}; }

bool is_ascii(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return c < 0x80; });
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// "%5B0%2C1%5D" to "[0,1]"; a malformed escape stays as it is.
std::string decode(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
                         hex_digit(text[i + 2]) >= 0;
    if (!escaped) {
      result += text[i];
      continue;
    }
    result += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
    i += 2;
  }
  return result;
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const auto end = std::min(text.find(at), text.size());
    if (end > 0) parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// The rest of a path under a folder; null when it is elsewhere.
std::optional<std::string_view> under(std::string_view path, std::string_view folder) {
  if (!path.starts_with(folder)) return std::nullopt;
  return path.substr(folder.size());
}

json ptp_state() {
  return {
      {"profile", "default"},
      {"port_data_set", {{"port_state", "LISTENING"}, {"port_identity", "bc0fa7.fffe.000001-1"}}},
      {"parent_data_set", {{"grandmaster_identity", "bc0fa7.fffe.000001"}}},
      {"current_data_set", {{"offset_from_master", 0}, {"steps_removed", 0}}},
      {"time_properties_data_set", {{"current_utc_offset", 37}}}};
}

}  // namespace

/// A target taken apart.
struct EmulatedSensor::Query {
  explicit Query(std::string_view target) {
    const auto mark = std::min(target.find('?'), target.size());
    path = target.substr(0, mark);
    if (mark == target.size()) return;
    for (const std::string& part : split(target.substr(mark + 1), '&')) {
      const auto equals = std::min(part.find('='), part.size());
      // '+' stays: it separates the arguments of commands.
      const std::string value = equals < part.size() ? part.substr(equals + 1) : std::string();
      values[part.substr(0, equals)] = value;
    }
  }

  [[nodiscard]] std::string value(const std::string& name, const char* otherwise) const {
    const auto found = values.find(name);
    return found == values.end() ? otherwise : decode(found->second);
  }
  [[nodiscard]] bool flag(const std::string& name, bool otherwise) const {
    const std::string text = value(name, otherwise ? "true" : "false");
    return text == "true" || text == "True" || text == "1";
  }

  std::string path;
  std::map<std::string, std::string> values;  ///< Still encoded.
};

EmulatedAnswer EmulatedSensor::answer(const EmulatedRequest& request) {
  ++counts_.requests;
  const Query query(request.target);
  const std::string_view path = query.path;
  const bool has_http = *parse_firmware_version(firmware_) >= FirmwareVersion{2, 0};
  if (!has_http) return not_found();
  if (path == "/api/v1/system/firmware") {
    return ok({{"fw", "ousteros-image-prod-emulated-" + firmware_}});
  }
  if (path == "/api/v1/system/network") return ok({{"hostname", "emulated"}});
  if (path == "/api/v1/system/restart" && request.method == "POST") {
    power_on();
    return ok(json::object());
  }
  if (const auto what = under(path, "/api/v1/time/")) return answer_time(*what);
  if (form_ == ApiForm::kTcp) return {500, "emulated firmware 2.0 has no reliable HTTP"};
  return answer_sensor(request, query);
}

EmulatedAnswer EmulatedSensor::answer_sensor(const EmulatedRequest& request, const Query& query) {
  const auto path = under(query.path, "/api/v1/sensor/");
  if (!path) return not_found();
  if (*path == "alerts") return ok(alerts());
  if (*path == "telemetry") {
    return ok({{"input_voltage_mv", 24000},
               {"input_current_ma", 700},
               {"internal_temperature_deg_c", 45},
               {"phase_lock_status", "DISABLED"},
               {"timestamp_ns", sensor_time_ns()}});
  }
  const bool commands = form_ == ApiForm::kCommandGroups || form_ == ApiForm::kCommands;
  if (commands && path->starts_with("cmd/")) return answer_command(query, request.client_address);
  if (!commands && *path == "config") return answer_config(request, query);
  if (form_ == ApiForm::kCommandGroups) return not_found();
  if (*path == "metadata") return ok(metadata());
  if (const auto group = under(*path, "metadata/")) {
    const json all = metadata();
    const auto found = all.find(*group);
    if (found != all.end()) return ok(*found);
  }
  return not_found();
}

EmulatedAnswer EmulatedSensor::answer_time(std::string_view what) const {
  if (what == "sensor") return ok(sensor_time());
  if (what == "ptp") return ok(ptp_state());
  if (what == "system") {
    return ok({{"monotonic", static_cast<double>(clock_.monotonic_ns()) * kSecondsPerNs}});
  }
  return not_found();
}

EmulatedAnswer EmulatedSensor::answer_config(const EmulatedRequest& request, const Query& query) {
  if (request.method == "GET") {
    const bool by_source = form_ == ApiForm::kTarget;
    const std::string source = by_source                      ? query.value("source", "active")
                               : query.flag("staging", false) ? "staged"
                                                              : "active";
    if (source == "staged") return ok(config_.staged());
    if (source == "persisted") return ok(config_.persisted());
    return source == "active" ? ok(config_.active()) : not_found();
  }
  auto changes = parse_sensor_json(request.body);
  if (!changes) return bad_request("not JSON");
  const std::string complaint = config_.complaint(*changes);
  if (!complaint.empty()) return bad_request(complaint);
  if (text_member(*changes, "udp_dest") == "@auto") (*changes)["udp_dest"] = request.client_address;
  return post_config(*changes, query);
}

EmulatedAnswer EmulatedSensor::post_config(const json& changes, const Query& query) {
  ++counts_.config_writes;
  if (form_ == ApiForm::kStaging) {
    config_.stage(changes);
    if (query.flag("staging", false)) return ok(config_.staged());
    config_.activate_staged();
    if (query.flag("persist", false)) save_flash(config_.active());
    if (query.flag("reinit", true)) reinitialise();
    return ok(config_.active());
  }
  // The real sensor's default too.
  const std::string target = query.value("target", "persisted");
  if (target == "staged") {
    config_.stage(changes);
    return ok(config_.staged());
  }
  const bool flash = target == "persisted" || target == "active_persisted";
  if (!flash && target != "active") return bad_request("no such target");
  if (flash) save_flash(changes);
  config_.activate(changes);
  reinitialise();
  return ok(config_.active());
}

EmulatedAnswer EmulatedSensor::answer_command(const Query& query, const std::string& client) {
  std::vector<std::string> words = {query.path.substr(query.path.rfind('/') + 1)};
  const auto arguments = query.values.find("args");
  if (arguments != query.values.end()) {
    for (const std::string& word : split(arguments->second, '+')) words.push_back(decode(word));
  }
  try {
    const json value = run_command(words, client);
    // Over HTTP only this one is echoed.
    if (value.is_string() && value != "set_config_param") return ok(json::object());
    return ok(value);
  } catch (const InputError& error) {
    return bad_request(error.what());
  }
}

std::string EmulatedSensor::answer_line(std::string_view line, const std::string& client) {
  ++counts_.requests;
  const std::vector<std::string> words = split(line, ' ');
  if (words.empty()) return "error: empty command";
  try {
    const json value = run_command(words, client);
    return value.is_string() ? value.get<std::string>() : value.dump();
  } catch (const InputError& error) {
    return fmt::format("error: {}", error.what());
  }
}

json EmulatedSensor::run_command(const std::vector<std::string>& words, const std::string& client) {
  // Anything else need not be text that an answer can repeat.
  if (!std::ranges::all_of(words, is_ascii)) throw InputError("a command must be in ASCII");
  const std::string& name = words.front();
  if (name == "get_alerts") return alerts();
  if (name == "get_time_info") return {{"sensor", sensor_time()}};
  if (name == "get_config_param") {
    return words.size() > 1 && words[1] == "staged" ? config_.staged() : config_.active();
  }
  if (name.starts_with("get_")) {
    const json all = metadata();
    const auto group = all.find(name.substr(4));
    if (group == all.end()) throw InputError("no such group");
    return *group;
  }
  if (name == "set_config_param") {
    set_param(words);
  } else if (name == "set_udp_dest_auto") {
    ++counts_.config_writes;
    config_.stage({{config_.destination_key(), client}});
  } else if (name == "reinitialize") {
    config_.activate_staged();
    reinitialise();
  } else if (name == "save_config_params" || name == "write_config_txt") {
    save_flash(config_.active());
  } else {
    throw InputError("invalid command " + excerpt(name, 40));
  }
  return name;
}

void EmulatedSensor::set_param(const std::vector<std::string>& words) {
  if (words.size() != 3) throw InputError("set_config_param takes a name and a value");
  const std::string& key = words[1];
  json changes;
  if (key == ".") {
    changes = parse_sensor_json(words[2]).value_or(json());
  } else if (member(config_.active(), key.c_str()).is_string()) {
    changes = {{key, words[2]}};
  } else {
    changes = {{key, parse_sensor_json(words[2]).value_or(json(words[2]))}};
  }
  const std::string complaint = config_.complaint(changes);
  if (!complaint.empty()) throw InputError(complaint);
  ++counts_.config_writes;
  config_.stage(changes);
}

}  // namespace glint::emulator
