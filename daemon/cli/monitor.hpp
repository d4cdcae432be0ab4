// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "daemon/cli/client_command.hpp"

namespace glint::cli {

/// Shows on the whole terminal how the daemon fares, until somebody asks to leave; connects anew
/// when the daemon went away. @throws UsageError without a terminal.
void run_monitor(const ClientOptions& options);

}  // namespace glint::cli
