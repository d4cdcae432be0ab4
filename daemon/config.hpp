// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "driver/core/error.hpp"
#include "driver/core/pose.hpp"
#include "slam/config.hpp"

namespace glint::daemon {

/// JSON with its keys in the order in which they were written.
using Json = nlohmann::ordered_json;

/// A configuration that cannot be used: the message names file, line, key and allowed range.
/// `glintd` exits with 78 on it, so that systemd does not start it again and again.
class ConfigError : public InputError {
 public:
  using InputError::InputError;
};

/// Everything that can be configured; the defaults are those of the members. Value type.
/// What each key does, its unit and its range stand in the table of config.cpp.
struct Config {
  struct Sensor {
    std::string host;
    bool configure = true;
    bool persist = false;
    std::string udp_dest = "auto";
    std::string lidar_mode;
    std::string timestamp_mode;
    std::string operating_mode;
    std::string udp_profile_lidar;
    std::string udp_profile_imu;
    std::vector<int> azimuth_window_mdeg;
    double signal_multiplier = 0.0;
    std::string metadata_file;
    std::string source_address;
    std::string bind_address;
    std::string multicast_group;
    int lidar_port = 0;
    int imu_port = 0;
    int rcvbuf_bytes = 8 << 20;
    std::string clock = "auto";
    int tai_utc_offset_s = 0;
  };
  struct Mount {
    Pose T_base_sensor;
  };
  struct Server {
    std::string listen = "127.0.0.1:7788";
    std::string unix_socket = "auto";
    std::string read_token_file;
    std::string control_token_file;
    bool require_token = false;
    std::string tls_certificate_file;
    std::string tls_key_file;
    int max_clients = 32;
    double idle_timeout_s = 900.0;
    double stall_timeout_s = 180.0;
    int outbox_bytes = 8 << 20;
    double max_requests_per_s = 1000.0;
  };
  struct State {
    std::string directory = "auto";
    int max_sessions_mb = 2000;
    int trajectory_poses = 200'000;
  };
  struct Map {
    std::string on_start = "new";
    double search_s = 60.0;
    int memory_mb = 250;
  };
  struct Metrics {
    std::string listen;
  };
  struct Log {
    std::string level = "info";
  };

  Sensor sensor;
  Mount mount;
  slam::SlamConfig slam;
  Server server;
  State state;
  Map map;
  Metrics metrics;
  Log log;
};

/// One row of the table of keys.
struct ConfigKey {
  using Accessor =
      std::variant<bool& (*)(Config&), int& (*)(Config&), double& (*)(Config&),
                   std::string& (*)(Config&), Pose& (*)(Config&), std::vector<int>& (*)(Config&)>;
  std::string_view name;  ///< Dotted: "slam.orb_features".
  Accessor field;         ///< The member; its type is the key's type.
  double min = 0.0;       ///< Smallest and largest value of a number, or of each of a list.
  double max = 0.0;
  std::string_view unit;  ///< Empty for none.
  /// Allowed strings, separated by "|"; empty for any. One that ends in ":NAME" stands for all that
  /// have the name of a map there. Of a number: kAuto, or empty.
  std::string_view choices;
  std::string_view doc;  ///< One sentence for the user.
};

/// What map.on_start begins with before the name of a map that is only read.
constexpr std::string_view kLocalizePrefix = "localize:";

/// What a number may be told as where Glint can find it itself, and how it is kept.
constexpr std::string_view kAuto = "auto";
constexpr double kAutoNumber = 0.0;
/// Whether the key's number may be kAuto.
inline bool takes_auto(const ConfigKey& key) {
  return key.choices == kAuto && std::holds_alternative<double& (*)(Config&)>(key.field);
}

/// Every key there is, in the order of the shipped file.
std::span<const ConfigKey> config_keys();

/// Where the values of a configuration come from, by dotted key: "FILE:LINE", "--set", or "preset
/// NAME" for what slam.preset brought. What is not in it has its default.
using ConfigOrigins = std::map<std::string, std::string, std::less<>>;

/// Reads a TOML file over `config`; slam.preset is applied before the other slam keys. `origins`,
/// if there are any, follow.
/// @throws ConfigError naming file and line for an unknown key (with the nearest known one), a
/// wrong type or a value out of range.
void load_config(const std::filesystem::path& file, Config& config,
                 ConfigOrigins* origins = nullptr);

/// Applies one `key=value`, the value as in TOML; a value that is no TOML is taken as a string.
/// Setting slam.preset replaces every slam value. @throws ConfigError.
void apply_setting(Config& config, std::string_view setting, ConfigOrigins* origins = nullptr);

/// Applies several settings in order, slam.preset first. @throws ConfigError.
void apply_settings(Config& config, std::span<const std::string> settings,
                    ConfigOrigins* origins = nullptr);

/// The effective configuration: an object for each group of keys.
Json to_json(const Config& config);

/// The configuration as a TOML file in which each key carries what it does, its unit and its range.
/// `group` restricts it to the keys of one group, e.g. "slam".
std::string to_toml(const Config& config, std::string_view group = {});

}  // namespace glint::daemon
