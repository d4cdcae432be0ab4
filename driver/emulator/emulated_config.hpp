// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "driver/session/firmware_version.hpp"

namespace glint::emulator {

/// An emulated sensor's settings: those in force, those staged for its next reinitialise, those in
/// its flash. Value type.
class EmulatedConfig {
 public:
  /// `config_params` is that group of a sensor's metadata; what it lacks gets the usual value.
  EmulatedConfig(FirmwareVersion firmware, const nlohmann::json& config_params);

  /// Null when the sensor would take this object of settings, else its complaint.
  [[nodiscard]] std::string complaint(const nlohmann::json& changes) const;
  void stage(const nlohmann::json& changes) { staged_.update(changes); }
  void activate_staged() { active_ = staged_; }
  void activate(const nlohmann::json& changes);
  void persist(const nlohmann::json& changes) { persisted_.update(changes); }
  /// What a loss of power leaves.
  void restore_persisted();

  [[nodiscard]] const nlohmann::json& active() const { return active_; }
  [[nodiscard]] const nlohmann::json& staged() const { return staged_; }
  [[nodiscard]] const nlohmann::json& persisted() const { return persisted_; }
  /// "udp_dest", or its older name.
  [[nodiscard]] const char* destination_key() const;
  [[nodiscard]] bool is_standby() const;

 private:
  nlohmann::json active_;
  nlohmann::json staged_;
  nlohmann::json persisted_;
};

}  // namespace glint::emulator
