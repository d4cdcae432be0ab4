// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>

namespace glint::cli {

/// Exit codes of `glint`; fixed, programs rely on them.
enum ExitCode { kDone = 0, kFailed = 1, kUsage = 2, kBadInput = 3, kNoDaemon = 4 };

/// Wrong use of the command line that CLI11 itself cannot see. Exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The daemon cannot be reached. Exit code 4.
class ConnectionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One function per sub-command, each in its own file: it registers the sub-command with `app`; its
// callback does the work and throws InputError (3), UsageError (2), ConnectionError (4), or any
// other exception (1) with one sentence to print.
void add_replay(CLI::App& app);
void add_dump(CLI::App& app);
void add_train_vocabulary(CLI::App& app);
void add_info(CLI::App& app);
void add_simulate(CLI::App& app);
void add_emulate(CLI::App& app);
void add_record(CLI::App& app);
void add_doctor(CLI::App& app);
void add_config(CLI::App& app);
void add_status(CLI::App& app);
void add_metrics(CLI::App& app);
void add_pose(CLI::App& app);
void add_watch(CLI::App& app);
void add_map(CLI::App& app);
void add_maps(CLI::App& app);
void add_merge(CLI::App& app);
void add_load(CLI::App& app);
void add_relocalize(CLI::App& app);
void add_trajectory(CLI::App& app);
void add_control(CLI::App& app);
void add_wait(CLI::App& app);
void add_save(CLI::App& app);
void add_delete_map(CLI::App& app);
void add_export(CLI::App& app);

}  // namespace glint::cli
