// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Configuration files, and single settings as --set takes them.
#include "daemon/config.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using glint::daemon::Config;

/// As long as a command line's argument may well be.
constexpr std::size_t kMaxSettingBytes = 200;

// What was taken, written out, is taken again and says the same.
void check(const Config& config) {
  static const auto defaults = to_json(Config());
  if (to_json(config) == defaults) return;  // Nothing to tell, and writing takes long.
  const std::string written = glint::daemon::to_toml(config);
  const glint::fuzz::MemoryFile file(std::as_bytes(std::span(written)));
  Config read;
  glint::daemon::load_config(file.path(), read);
  glint::fuzz::require(glint::daemon::to_toml(read) == written, "what is written reads back equal");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Config config;
  try {
    const glint::fuzz::MemoryFile file(glint::fuzz::as_bytes(data, size));
    glint::daemon::load_config(file.path(), config);
    check(config);
  } catch (const glint::daemon::ConfigError&) {
    // The verdict that most inputs deserve.
  }
  if (size > kMaxSettingBytes) return 0;
  try {
    config = {};
    glint::daemon::apply_setting(config, glint::fuzz::as_text(data, size));
    check(config);
  } catch (const glint::daemon::ConfigError&) {
    // As above.
  }
  return 0;
}
