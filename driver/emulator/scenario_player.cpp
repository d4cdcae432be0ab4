// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/scenario_player.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "driver/core/time.hpp"

namespace glint::emulator {
namespace {

std::int64_t to_ns(double seconds) { return std::llround(seconds / kSecondsPerNs); }

}  // namespace

ScenarioPlayer::ScenarioPlayer(Scenario scenario, SensorEmulator& emulator,
                               PacketFaultSink& packets, const PacketFaults& faults)
    : events_(std::move(scenario)), emulator_(emulator), packets_(packets), faults_(faults) {}

std::optional<std::int64_t> ScenarioPlayer::play(std::int64_t elapsed_ns) {
  while (!events_.empty()) {
    const auto first = std::ranges::min_element(events_, {}, &ScenarioEvent::at_ns);
    if (first->at_ns > elapsed_ns) return first->at_ns;
    const ScenarioEvent event = *first;
    if (event.every_ns > 0) {
      first->at_ns += event.every_ns;
    } else {
      events_.erase(first);
    }
    apply(event);
  }
  return std::nullopt;
}

void ScenarioPlayer::apply(const ScenarioEvent& event) {
  const auto spoil = [&](ControlFault fault) {
    emulator_.inject({fault, static_cast<int>(event.value), {}});
  };
  switch (event.action) {
    case ScenarioAction::kPowerOff:
      return emulator_.power_off();
    case ScenarioAction::kPowerOn:
      return emulator_.power_on();
    case ScenarioAction::kRestart:
      return emulator_.restart();
    case ScenarioAction::kLoss:
      faults_.loss = event.value;
      return packets_.set_faults(faults_);
    case ScenarioAction::kReordering:
      faults_.reordering = event.value;
      return packets_.set_faults(faults_);
    case ScenarioAction::kDuplicates:
      faults_.duplicates = event.value;
      return packets_.set_faults(faults_);
    case ScenarioAction::kDelay:
      faults_.delay_ns = to_ns(event.value);
      return packets_.set_faults(faults_);
    case ScenarioAction::kClockJump:
      return emulator_.jump_clock(to_ns(event.value));
    case ScenarioAction::kForeignPackets:
      return packets_.send_foreign(static_cast<std::uint64_t>(event.value));
    case ScenarioAction::kAlert:
      return emulator_.raise_alert(event.id, event.category, "by scenario");
    case ScenarioAction::kClearAlerts:
      return emulator_.clear_alerts();
    case ScenarioAction::kServerErrors:
      return spoil(ControlFault::kServerError);
    case ScenarioAction::kSlowAnswers:
      return spoil(ControlFault::kSlow);
    case ScenarioAction::kGarbageAnswers:
      return spoil(ControlFault::kGarbage);
    case ScenarioAction::kHalfAnswers:
      return spoil(ControlFault::kHalfAnswer);
  }
}

}  // namespace glint::emulator
