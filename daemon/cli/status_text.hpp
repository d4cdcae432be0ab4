// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

#include "daemon/config.hpp"

namespace glint::cli {

/// Of the counters of a status those of losses in which something happened: "kernel_drops 3,
/// late_packets 12", or "none".
std::string losses_text(const daemon::Json& counters);

}  // namespace glint::cli
