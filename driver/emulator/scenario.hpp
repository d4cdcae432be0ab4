// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint::emulator {

/// What can befall an emulated sensor or its network.
enum class ScenarioAction {
  kPowerOff,
  kPowerOn,
  kRestart,         ///< Loses power for a moment.
  kLoss,            ///< From now on this share of packets is lost.
  kReordering,      ///< From now on this share of packets comes late.
  kDuplicates,      ///< From now on this share of packets comes twice.
  kDelay,           ///< From now on every packet is so many seconds on the way.
  kClockJump,       ///< The sensor's clock jumps by so many seconds, forwards or back.
  kForeignPackets,  ///< So many packets of somebody else.
  kAlert,
  kClearAlerts,
  kServerErrors,    ///< So many HTTP answers are 500.
  kSlowAnswers,     ///< So many HTTP answers never come.
  kGarbageAnswers,  ///< So many HTTP answers are no HTTP.
  kHalfAnswers,     ///< So many HTTP answers break off.
};

/// One event. Value type.
struct ScenarioEvent {
  std::int64_t at_ns = 0;     ///< After the start.
  std::int64_t every_ns = 0;  ///< Happens again after so long; 0: once.
  ScenarioAction action = ScenarioAction::kRestart;
  double value = 0.0;    ///< Share, seconds or count, as the action has it.
  std::string category;  ///< Of an alert.
  std::string id;        ///< Of an alert.
};

using Scenario = std::vector<ScenarioEvent>;

/// Reads a scenario: a TOML file of [[event]] tables such as
///   [[event]]
///   at_s = 30.0
///   action = "loss"
///   share = 0.05
/// `every_s` repeats an event. `name` is used in messages.
/// @throws InputError that names file, line, what is wrong, and what is possible.
Scenario parse_scenario(std::string_view toml, std::string_view name);

/// Reads a scenario file. @throws InputError as above, also when it cannot be read.
Scenario load_scenario(const std::filesystem::path& file);

}  // namespace glint::emulator
