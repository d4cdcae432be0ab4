// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// From TOML to Config by the table of keys.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/config.hpp"
#include "daemon/config_form.hpp"
#include "daemon/saved_maps.hpp"
#include "driver/core/edit_distance.hpp"

namespace glint::daemon {
namespace {

const ConfigKey& find_key(std::string_view name, const std::string& where) {
  const auto keys = config_keys();
  const auto found = std::ranges::find(keys, name, &ConfigKey::name);
  if (found != keys.end()) return *found;
  const auto nearest = std::ranges::min_element(
      keys, {}, [&](const ConfigKey& key) { return edit_distance(name, key.name); });
  throw ConfigError(fmt::format("{}: unknown key '{}'; the nearest known key is '{}'", where, name,
                                nearest->name));
}

std::string allowed(const ConfigKey& key) {
  if (const auto form = config_form(key.name); !form.empty()) return std::string(form);
  if (!key.choices.empty() && !takes_auto(key)) return fmt::format("one of {}", key.choices);
  const std::string unit = key.unit.empty() ? "" : fmt::format(" {}", key.unit);
  constexpr std::array<std::string_view, 6> kTypes = {"true or false",
                                                      "a whole number",
                                                      "a number",
                                                      "a string in quotes",
                                                      "seven numbers [x, y, z, qx, qy, qz, qw]",
                                                      "[] or two whole numbers [start, end]"};
  std::string text(takes_auto(key) ? "\"auto\" or " : "");
  text += kTypes[key.field.index()];
  if (key.min < key.max) text += fmt::format(" from {} to {}{}", key.min, key.max, unit);
  return text;
}

[[noreturn]] void reject(const ConfigKey& key, const toml::node& node, const std::string& where) {
  std::ostringstream value;
  node.visit([&](const auto& n) { value << toml::toml_formatter{n}; });
  throw ConfigError(fmt::format("{}: '{}' cannot be {}; it must be {}", where, key.name,
                                value.str(), allowed(key)));
}

bool in_range(const ConfigKey& key, double value) {
  return std::isfinite(value) && value >= key.min && value <= key.max;
}

bool is_choice(std::string_view choices, std::string_view value) {
  if (choices.empty()) return true;
  const std::string list = fmt::format("|{}|", choices);
  const auto is_listed = [&](std::string_view choice) {
    return list.find(fmt::format("|{}|", choice)) != std::string::npos;
  };
  const auto colon = value.find(':');
  if (colon == std::string_view::npos) return !value.empty() && is_listed(value);
  return SavedMaps::is_name(value.substr(colon + 1)) &&
         is_listed(fmt::format("{}:NAME", value.substr(0, colon)));
}

bool read(const ConfigKey&, const toml::node& node, bool& out) {
  const auto value = node.value_exact<bool>();
  if (value) out = *value;
  return value.has_value();
}

bool read(const ConfigKey& key, const toml::node& node, int& out) {
  const auto value = node.value_exact<std::int64_t>();
  if (!value || !in_range(key, static_cast<double>(*value))) return false;
  out = static_cast<int>(*value);
  return true;
}

bool read(const ConfigKey& key, const toml::node& node, double& out) {
  if (takes_auto(key) && node.value_exact<std::string>() == kAuto) {
    out = kAutoNumber;
    return true;
  }
  if (!node.is_number()) return false;
  const auto value = node.value<double>();
  if (!value || !in_range(key, *value) || !has_config_form(key.name, *value)) return false;
  out = *value;
  return true;
}

bool read(const ConfigKey& key, const toml::node& node, std::string& out) {
  const auto value = node.value_exact<std::string>();
  if (!value || !is_choice(key.choices, *value)) return false;
  if (!has_config_form(key.name, *value)) return false;
  out = *value;
  return true;
}

bool read(const ConfigKey& key, const toml::node& node, std::vector<int>& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr || (array->size() != 0 && array->size() != 2)) return false;
  std::vector<int> values(array->size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!read(key, (*array)[i], values[i])) return false;
  }
  out = std::move(values);
  return true;
}

bool read(const ConfigKey& key, const toml::node& node, Pose& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 7) return false;
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!read(key, (*array)[i], v[i])) return false;
  }
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  // Loose enough for four decimals, tight enough to catch Euler angles.
  if (std::abs(rotation.norm() - 1.0) > 1e-2) return false;
  out = {rotation.normalized(), {v[0], v[1], v[2]}};
  return true;
}

void apply(Config& config, const ConfigKey& key, const toml::node& node, const std::string& where) {
  const bool ok = std::visit([&](auto field) { return read(key, node, field(config)); }, key.field);
  if (!ok) reject(key, node, where);
  if (key.name == "slam.preset") config.slam = slam::preset_config(config.slam.preset);
}

/// As apply() has it: a preset replaces every value of its group.
void note_origin(ConfigOrigins* origins, const Config& config, const ConfigKey& key,
                 std::string origin) {
  if (origins == nullptr) return;
  if (key.name == "slam.preset") {
    for (const ConfigKey& other : config_keys()) {
      if (!other.name.starts_with("slam.")) continue;
      origins->insert_or_assign(std::string(other.name), "preset " + config.slam.preset);
    }
  }
  origins->insert_or_assign(std::string(key.name), std::move(origin));
}

struct Setting {
  std::string name;
  const toml::node* node;
};

/// The leaves of a table under their dotted names.
void flatten(const toml::table& table, const std::string& prefix, std::vector<Setting>& out) {
  for (const auto& [name, node] : table) {
    const std::string dotted = prefix + std::string(name.str());
    if (const toml::table* inner = node.as_table()) {
      flatten(*inner, dotted + ".", out);
    } else {
      out.push_back({dotted, &node});
    }
  }
}

/// Brings slam.preset to the front: it replaces every other slam value.
template <class Range, class IsPreset>
void preset_first(Range& range, IsPreset is_preset) {
  std::stable_partition(range.begin(), range.end(), is_preset);
}

toml::table parse_setting_value(const std::string& text) {
  try {
    return toml::parse("value = " + text);
  } catch (const toml::parse_error&) {
    return toml::table{{"value", text}};
  }
}

}  // namespace

void load_config(const std::filesystem::path& file, Config& config, ConfigOrigins* origins) {
  toml::table table;
  try {
    table = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    const std::string where = line > 0 ? fmt::format("{}:{}", file.string(), line) : file.string();
    throw ConfigError(fmt::format("{}: {}", where, error.description()));
  }
  std::vector<Setting> settings;
  flatten(table, "", settings);
  preset_first(settings, [](const Setting& s) { return s.name == "slam.preset"; });
  for (const Setting& setting : settings) {
    const std::string where =
        fmt::format("{}:{}", file.string(), setting.node->source().begin.line);
    const ConfigKey& key = find_key(setting.name, where);
    apply(config, key, *setting.node, where);
    note_origin(origins, config, key, where);
  }
}

void apply_setting(Config& config, std::string_view setting, ConfigOrigins* origins) {
  const auto equals = setting.find('=');
  if (equals == std::string_view::npos) {
    throw ConfigError(fmt::format("--set {}: expected KEY=VALUE", setting));
  }
  const std::string where = fmt::format("--set {}", setting);
  const ConfigKey& key = find_key(setting.substr(0, equals), where);
  const toml::table table = parse_setting_value(std::string(setting.substr(equals + 1)));
  apply(config, key, *table.get("value"), where);
  note_origin(origins, config, key, "--set");
}

void apply_settings(Config& config, std::span<const std::string> settings, ConfigOrigins* origins) {
  std::vector<std::string> ordered(settings.begin(), settings.end());
  preset_first(ordered, [](const std::string& s) { return s.starts_with("slam.preset="); });
  for (const std::string& setting : ordered) apply_setting(config, setting, origins);
}

}  // namespace glint::daemon
