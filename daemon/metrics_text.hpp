// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

#include "daemon/config.hpp"
#include "daemon/stage_stats.hpp"

namespace glint::daemon {

/// What get_status tells, and the distribution of each stage's time, in Prometheus' text format
/// 0.0.4. `status`: of status_json(). Seconds and bytes, as Prometheus wants them.
std::string metrics_text(const Json& status, const StageStats& stages);

}  // namespace glint::daemon
