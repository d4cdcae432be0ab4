// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/config_layers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

/// The drop-in files that belong to `file`. Others than *.toml are left alone: editors leave such.
std::vector<fs::path> drop_ins_of(const fs::path& file) {
  const fs::path directory = file.string() + ".d";
  std::vector<fs::path> found;
  std::error_code error;
  if (!fs::exists(directory, error)) return found;
  for (auto entry = fs::directory_iterator(directory, error); !error && entry != end(entry);
       entry.increment(error)) {
    if (entry->path().extension() == ".toml") found.push_back(entry->path());
  }
  if (error) {
    throw ConfigError(
        fmt::format("{}: cannot be listed ({}); it must be a directory that glintd "
                    "may read, or be away",
                    directory.string(), error.message()));
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

LayeredConfig read_config_layers(const fs::path& file, std::span<const std::string> settings) {
  LayeredConfig layered;
  const fs::path main = file.empty() ? fs::path(kUsualConfigFile) : file;
  if (!file.empty() || fs::exists(main)) layered.files.push_back(main);
  std::ranges::copy(drop_ins_of(main), std::back_inserter(layered.files));
  for (const fs::path& each : layered.files) {
    load_config(each, layered.config, &layered.origins);
  }
  apply_settings(layered.config, settings, &layered.origins);
  return layered;
}

}  // namespace glint::daemon
