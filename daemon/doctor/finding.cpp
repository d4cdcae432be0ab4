// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/doctor/finding.hpp"

#include <algorithm>

namespace glint::daemon {

std::string_view to_string(FindingLevel level) {
  switch (level) {
    case FindingLevel::kOk:
      return "OK";
    case FindingLevel::kWarn:
      return "WARN";
    case FindingLevel::kFail:
      return "FAIL";
  }
  return "FAIL";
}

const Finding* first_failure(std::span<const Finding> findings) {
  const auto found = std::ranges::find(findings, FindingLevel::kFail, &Finding::level);
  return found == findings.end() ? nullptr : &*found;
}

}  // namespace glint::daemon
