// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/status_text.hpp"

#include <fmt/format.h>

namespace glint::cli {

std::string losses_text(const daemon::Json& counters) {
  std::string text;
  for (const char* name :
       {"kernel_drops", "foreign_packets", "early_packets", "queue_drops", "missing_packets",
        "late_packets", "duplicate_packets", "corrupt_packets", "bad_size", "bad_type",
        "bad_serial", "bad_columns", "incomplete_scans", "paused_scans", "dropped_keyframes",
        "store_failures"}) {
    const auto value = counters.value(name, std::uint64_t{0});
    if (value > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value);
  }
  return text.empty() ? "none" : text;
}

}  // namespace glint::cli
