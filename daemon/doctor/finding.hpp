// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::daemon {

enum class FindingLevel { kOk, kWarn, kFail };

/// "OK", "WARN", "FAIL".
std::string_view to_string(FindingLevel level);

/// What a look at one thing showed. Value type.
struct Finding {
  FindingLevel level = FindingLevel::kOk;
  std::string step;  ///< What was looked at: "route", "ports", ...
  std::string what;  ///< One sentence.
  std::string mend;  ///< The line that mends it: a command or a setting; empty when it is OK.
};

/// Nothing to mend.
inline Finding ok(std::string step, std::string what) {
  return {FindingLevel::kOk, std::move(step), std::move(what), ""};
}

using Findings = std::vector<Finding>;

/// The first that fails, in the order of the way from the sensor to the program; null for none.
const Finding* first_failure(std::span<const Finding> findings);

}  // namespace glint::daemon
