// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint config: the configuration that glintd would start with, and where each value comes from.
#include "daemon/config.hpp"

#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "daemon/cli/command.hpp"
#include "daemon/config_layers.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct ConfigCommand {
  std::string file;
  std::vector<std::string> settings;
  bool json = false;
};

/// Each group's keys with their `value` and where it is `from`.
Json traced_json(const daemon::LayeredConfig& layered) {
  Json groups = Json::object();
  const Json config = daemon::to_json(layered.config);
  for (const auto& [group, values] : config.items()) {
    for (const auto& [name, value] : values.items()) {
      const auto origin = layered.origins.find(fmt::format("{}.{}", group, name));
      groups[group][name] = Json{
          {"value", value}, {"from", origin == layered.origins.end() ? "default" : origin->second}};
    }
  }
  return groups;
}

void print_traced(const Json& groups) {
  const char* before = "";
  for (const auto& [group, keys] : groups.items()) {
    fmt::print("{}[{}]\n", before, group);
    for (const auto& [name, key] : keys.items()) {
      fmt::print("{:<48} # {}\n", fmt::format("{} = {}", name, key["value"].dump()),
                 key["from"].get<std::string>());
    }
    before = "\n";
  }
}

void print_config(const ConfigCommand& command) {
  const daemon::LayeredConfig layered = daemon::read_config_layers(command.file, command.settings);
  const Json groups = traced_json(layered);
  if (!command.json) return print_traced(groups);
  Json files = Json::array();
  for (const auto& file : layered.files) files.push_back(file.string());
  std::cout << Json{{"files", files}, {"config", groups}}.dump(2) << '\n';
}

}  // namespace

void add_config(CLI::App& app) {
  auto command = std::make_shared<ConfigCommand>();
  CLI::App* sub =
      app.add_subcommand("config", "Print every value glintd starts with, and where it comes from");
  sub->add_option("--config", command->file,
                  "Configuration file, with FILE.d/*.toml over it (default: " +
                      std::string(daemon::kUsualConfigFile) + ")");
  sub->add_option("--set", command->settings, "As for glintd: key=value; may be given again");
  sub->add_flag("--json", command->json, "Print JSON, with the files that were read");
  sub->callback([command] { print_config(*command); });
}

}  // namespace glint::cli
