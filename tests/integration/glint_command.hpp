// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>
#include <vector>

namespace glint::test {

/// How a run of `glint` ended.
struct CommandResult {
  int exit_code = -1;  ///< -1 when a signal ended it: it crashed.
  std::string out;     ///< Standard output and standard error.
};

/// Runs the `glint` that was built with this test and waits for it.
CommandResult run_glint(const std::vector<std::string>& arguments);

}  // namespace glint::test
