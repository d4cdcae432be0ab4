// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/scenario.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

#include "driver/core/error.hpp"
#include "driver/core/time.hpp"

namespace glint::emulator {
namespace {

/// How an action is written: its name, and the key of its value with the range.
struct ActionRow {
  std::string_view name;
  ScenarioAction action;
  std::string_view value_key;  ///< Empty: it has none.
  double least = 0.0;
  double largest = 0.0;
};

constexpr double kDay_s = 86'400.0;
constexpr double kMany = 1e6;
constexpr double kNearlyAll = 0.999;

constexpr std::array<ActionRow, 15> kActions = {{
    {"power_off", ScenarioAction::kPowerOff, ""},
    {"power_on", ScenarioAction::kPowerOn, ""},
    {"restart", ScenarioAction::kRestart, ""},
    {"loss", ScenarioAction::kLoss, "share", 0.0, kNearlyAll},
    {"reordering", ScenarioAction::kReordering, "share", 0.0, kNearlyAll},
    {"duplicates", ScenarioAction::kDuplicates, "share", 0.0, kNearlyAll},
    {"delay", ScenarioAction::kDelay, "seconds", 0.0, 10.0},
    {"clock_jump", ScenarioAction::kClockJump, "seconds", -1e9, 1e9},
    {"foreign_packets", ScenarioAction::kForeignPackets, "count", 1.0, kMany},
    {"alert", ScenarioAction::kAlert, ""},
    {"clear_alerts", ScenarioAction::kClearAlerts, ""},
    {"server_errors", ScenarioAction::kServerErrors, "count", 1.0, kMany},
    {"slow_answers", ScenarioAction::kSlowAnswers, "count", 1.0, kMany},
    {"garbage_answers", ScenarioAction::kGarbageAnswers, "count", 1.0, kMany},
    {"half_answers", ScenarioAction::kHalfAnswers, "count", 1.0, kMany},
}};

/// Reads one [[event]], with messages that name its place.
class EventReader {
 public:
  EventReader(const toml::table& table, std::string_view name) : table_(table), name_(name) {}

  ScenarioEvent read() {
    ScenarioEvent event;
    event.at_ns = to_ns(required_number("at_s", 0.0, kDay_s));
    if (table_.contains("every_s")) {
      event.every_ns = to_ns(required_number("every_s", 0.001, kDay_s));
    }
    const ActionRow& row = action();
    event.action = row.action;
    if (!row.value_key.empty()) {
      event.value = required_number(row.value_key, row.least, row.largest);
    }
    if (event.value != std::floor(event.value) && row.value_key == "count") {
      fail("count", "must be a whole number");
    }
    if (row.action == ScenarioAction::kAlert) {
      event.category = text("category", "OVERTEMP");
      event.id = text("id", "0x01000000");
    }
    refuse_others(row);
    return event;
  }

 private:
  [[noreturn]] void fail(std::string_view key, std::string_view what) const {
    const toml::node* const node = table_.get(key);
    const auto line = (node != nullptr ? node->source() : table_.source()).begin.line;
    throw InputError(fmt::format("{}:{}: {} {}", name_, line, key, what));
  }

  static std::int64_t to_ns(double seconds) { return std::llround(seconds / kSecondsPerNs); }

  double required_number(std::string_view key, double least, double largest) const {
    const toml::node* const node = table_.get(key);
    const auto value = node != nullptr ? node->value<double>() : std::nullopt;
    // Also false for NaN.
    const bool good = node != nullptr && node->is_number() && *value >= least && *value <= largest;
    if (!good) fail(key, fmt::format("must be a number from {} to {}", least, largest));
    return *value;
  }

  std::string text(std::string_view key, std::string_view otherwise) const {
    const toml::node* const node = table_.get(key);
    if (node == nullptr) return std::string(otherwise);
    const auto value = node->value_exact<std::string>();
    if (!value) fail(key, "must be a string in quotes");
    return *value;
  }

  const ActionRow& action() const {
    const std::string wanted = text("action", "");
    const std::string_view name = wanted;
    const auto found = std::ranges::find(kActions, name, &ActionRow::name);
    if (found != kActions.end()) return *found;
    std::string known;
    for (const ActionRow& row : kActions)
      known += (known.empty() ? "" : ", ") + std::string(row.name);
    fail("action", fmt::format("cannot be \"{}\"; it is one of {}", wanted, known));
  }

  void refuse_others(const ActionRow& row) const {
    for (const auto& [key, node] : table_) {
      const std::string_view name = key.str();
      const bool of_alert =
          row.action == ScenarioAction::kAlert && (name == "category" || name == "id");
      if (name == "at_s" || name == "every_s" || name == "action" || of_alert) continue;
      if (!row.value_key.empty() && name == row.value_key) continue;
      fail(name,
           fmt::format("is no key of the action {}; remove it{}", row.name,
                       row.value_key.empty() ? "" : fmt::format(", or write {}", row.value_key)));
    }
  }

  const toml::table& table_;
  const std::string_view name_;
};

toml::table parse_table(std::string_view text, std::string_view name) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: {}", name, error.source().begin.line, error.description()));
  }
}

}  // namespace

Scenario parse_scenario(std::string_view text, std::string_view name) {
  const toml::table root = parse_table(text, name);
  const toml::array* const events = root.get_as<toml::array>("event");
  if (events == nullptr || root.size() != 1) {
    throw InputError(
        fmt::format("{}: a scenario holds [[event]] tables and nothing else; write e.g. [[event]], "
                    "at_s = 10.0, action = \"restart\"",
                    name));
  }
  Scenario scenario;
  for (const toml::node& node : *events) {
    const toml::table* const table = node.as_table();
    if (table == nullptr) {
      throw InputError(fmt::format("{}:{}: event must be written as [[event]] tables", name,
                                   node.source().begin.line));
    }
    scenario.push_back(EventReader(*table, name).read());
  }
  std::ranges::stable_sort(scenario, {}, &ScenarioEvent::at_ns);
  return scenario;
}

Scenario load_scenario(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return parse_scenario(text, file.string());
}

}  // namespace glint::emulator
