// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/cli/replay_run.hpp"

namespace glint::cli {

/// Writes `report.html`: one file that needs no network, with the trajectory from above and in
/// height, loops accepted and refused, tracking over time, the time of each stage, and sample
/// intensity images.
/// `title` is the capture's name; `summary` the content of summary.json. @throws InputError.
void write_report(const std::filesystem::path& file, const std::string& title,
                  const nlohmann::ordered_json& summary, const ReplayResult& result);

}  // namespace glint::cli
