// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "daemon/config.hpp"

namespace glint::daemon {

/// Where glintd looks for its configuration unless it is told another file. It need not exist.
constexpr const char* kUsualConfigFile = "/etc/glint/glint.toml";

/// A configuration as it was read, each layer over those before it. Value type.
struct LayeredConfig {
  Config config;
  ConfigOrigins origins;
  std::vector<std::filesystem::path> files;  ///< That were read, in this order.
};

/// Reads the defaults, `file`, then FILE.d/*.toml in the order of their names, then `settings`
/// (KEY=VALUE each). An empty `file` is kUsualConfigFile, as far as it is there.
/// @throws ConfigError as load_config and apply_settings do, and when FILE.d cannot be listed.
LayeredConfig read_config_layers(const std::filesystem::path& file,
                                 std::span<const std::string> settings);

}  // namespace glint::daemon
