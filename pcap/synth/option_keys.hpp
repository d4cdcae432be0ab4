// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "pcap/synth/simulation_options.hpp"

namespace glint::synth {

/// An option of a simulation by name, as command lines spell it.
struct OptionKey {
  std::string_view name;
  std::string_view what;  ///< With unit and range.
  bool repeats = false;   ///< May be given more than once.
  std::string (*get)(const SimulationOptions& options);
  /// @throws OptionError that names the option, InputError for a file that cannot be used.
  void (*set)(SimulationOptions& options, const std::string& text);
};

/// All of them but the world's name.
std::span<const OptionKey> option_keys();

/// "WORLD" or "WORLD,name=value,name=value...": how a daemon is told what to simulate.
/// What is not named stays as in `options`. @throws OptionError, InputError as above.
SimulationOptions parse_simulation(std::string_view text, SimulationOptions options = {});

}  // namespace glint::synth
