// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

#include "daemon/cli/client_command.hpp"

namespace glint::cli {

/// Has the daemon begin a job and waits for its end; the share that is done is shown on a terminal.
/// With --json the job is printed. @throws std::runtime_error that begins with `failure` when it
/// did not come to a good end, what the client throws else.
daemon::Json run_job(daemon::Client& client, const ClientOptions& options,
                     const std::string& method, const daemon::Json& params,
                     const std::string& failure);

}  // namespace glint::cli
