// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Scenario files of the emulated sensor.
#include "driver/core/error.hpp"
#include "driver/emulator/scenario.hpp"
#include "tests/fuzz/require.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    for (const auto& event :
         glint::emulator::parse_scenario(glint::fuzz::as_text(data, size), "fuzz.toml")) {
      glint::fuzz::require(event.at_ns >= 0 && event.every_ns >= 0, "times are not negative");
    }
  } catch (const glint::InputError&) {
    // The verdict that most inputs deserve.
  }
  return 0;
}
