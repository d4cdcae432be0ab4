// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/emulated_config.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace glint::emulator {
namespace {

using nlohmann::json;

/// Settings that firmware 1 does not have, though the metadata may be of a later one.
constexpr std::array kLaterKeys = {"udp_dest", "operating_mode", "udp_profile_lidar",
                                   "udp_profile_imu"};

json usual_config(FirmwareVersion firmware) {
  json config = {{"udp_port_lidar", 7502},
                 {"udp_port_imu", 7503},
                 {"lidar_mode", "1024x10"},
                 {"timestamp_mode", "TIME_FROM_INTERNAL_OSC"}};
  if (firmware.major_number < 2) {
    config["udp_ip"] = "";
    config["auto_start_flag"] = 1;
    return config;
  }
  config.update({{"udp_dest", ""},
                 {"operating_mode", "NORMAL"},
                 {"azimuth_window", {0, 360000}},
                 {"phase_lock_enable", false},
                 {"phase_lock_offset", 0},
                 {"signal_multiplier", 1},
                 {"columns_per_packet", 16},
                 {"udp_profile_lidar", "LEGACY"},
                 {"udp_profile_imu", "LEGACY"}});
  if (firmware >= FirmwareVersion{3, 0}) {
    config["return_order"] = "STRONGEST_TO_WEAKEST";
    config["min_range_threshold_cm"] = 50;
  }
  if (firmware >= FirmwareVersion{3, 1}) config["udp_multicast_ttl"] = 1;
  return config;
}

bool is_lidar_mode(const json& value) {
  constexpr std::array<std::string_view, 6> kModes = {"512x10",  "512x20",  "1024x10",
                                                      "1024x20", "2048x10", "4096x5"};
  for (const std::string_view mode : kModes) {
    if (value == mode) return true;
  }
  return false;
}

bool is_port(const json& value) {
  return value.is_number_integer() && value >= 0 && value <= 65535;
}

}  // namespace

EmulatedConfig::EmulatedConfig(FirmwareVersion firmware, const json& config_params)
    : active_(usual_config(firmware)) {
  if (config_params.is_object()) active_.update(config_params);
  if (firmware.major_number < 2) {
    if (active_.contains("udp_dest")) active_["udp_ip"] = active_["udp_dest"];
    for (const char* later : kLaterKeys) active_.erase(later);
  } else {
    active_.erase("udp_ip");
  }
  staged_ = active_;
  persisted_ = active_;
}

std::string EmulatedConfig::complaint(const json& changes) const {
  if (!changes.is_object()) return "settings must be an object";
  for (const auto& [key, value] : changes.items()) {
    if (!active_.contains(key)) return fmt::format("{} is not a valid parameter", key);
    const bool is_port_key = key == "udp_port_lidar" || key == "udp_port_imu";
    const bool invalid = (key == "lidar_mode" && !is_lidar_mode(value)) ||
                         (is_port_key && !is_port(value)) ||
                         (!active_[key].is_number() && value.type() != active_[key].type());
    if (invalid) return fmt::format("{} cannot be {}", key, value.dump());
  }
  return {};
}

void EmulatedConfig::activate(const json& changes) {
  active_.update(changes);
  staged_ = active_;
}

void EmulatedConfig::restore_persisted() {
  active_ = persisted_;
  staged_ = persisted_;
}

const char* EmulatedConfig::destination_key() const {
  return active_.contains("udp_dest") ? "udp_dest" : "udp_ip";
}

bool EmulatedConfig::is_standby() const {
  return active_.value("operating_mode", "NORMAL") == "STANDBY" ||
         active_.value("auto_start_flag", json(1)) == 0;
}

}  // namespace glint::emulator
