// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "daemon/config.hpp"
#include "daemon/runtime.hpp"
#include "daemon/sensor_settings.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::daemon {

/// The command line's part of where packets come from.
struct InputOptions {
  std::string source = "udp";  ///< "udp", "pcap:FILE" or "synth:WORLD[,name=value...]".
  std::string metadata;        ///< Goes before sensor.metadata_file.
  std::string rate = "1";      ///< Of a capture: "max" or a multiple of the recorded speed.
};

struct Input {
  std::optional<SensorInfo> info;  ///< Null: the sensor will say.
  std::unique_ptr<PacketSource> source;
  RuntimeOptions options;                   ///< All but the session file.
  std::optional<SensorLinkOptions> sensor;  ///< The session with it; null for none.
};

/// Opens the source. @throws ConfigError when options, metadata or capture cannot be used, plain
/// InputError when a port is held.
Input open_input(const InputOptions& options, const Config& config);

/// The file for this run's session under state.directory; empty when none is to be kept.
/// @throws ConfigError if the directory cannot be made.
std::filesystem::path new_session_file(const Config& config);

}  // namespace glint::daemon
