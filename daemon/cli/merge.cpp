// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint merge: one session of several that overlap.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/cli/command.hpp"
#include "daemon/steady_clock.hpp"
#include "driver/core/error.hpp"
#include "slam/merge/session_merge.hpp"

namespace glint::cli {
namespace {

struct MergeCommand {
  std::vector<std::filesystem::path> sessions;
  std::filesystem::path out;
  bool force = false;
  bool json = false;
};

void check_target(const MergeCommand& command) {
  std::error_code ignored;
  for (const std::filesystem::path& session : command.sessions) {
    if (!std::filesystem::equivalent(session, command.out, ignored)) continue;
    throw InputError(fmt::format("{} is one of the sessions to merge; name another file with --out",
                                 command.out.string()));
  }
  if (command.force || !std::filesystem::exists(command.out)) return;
  throw InputError(fmt::format("{} is there already; name another file, or replace it with --force",
                               command.out.string()));
}

void run(const MergeCommand& command) {
  check_target(command);
  const slam::MergeSummary summary =
      slam::merge_sessions(command.sessions, command.out, daemon::stage_clock());
  if (command.json) {
    std::cout << nlohmann::ordered_json{{"file", command.out.string()},
                                        {"sessions", summary.sessions},
                                        {"keyframes_kept", summary.kept},
                                        {"keyframes_thinned", summary.thinned},
                                        {"joints", summary.joints},
                                        {"loops", summary.loops},
                                        {"seconds", summary.seconds}}
                     .dump()
              << '\n';
    return;
  }
  fmt::print(
      "{}: {} sessions, {} keyframes and {} that show nothing new, {} loops between sessions, {} "
      "in all; {:.1f} s\n",
      command.out.string(), summary.sessions, summary.kept, summary.thinned, summary.joints,
      summary.loops, summary.seconds);
}

}  // namespace

void add_merge(CLI::App& app) {
  auto command = std::make_shared<MergeCommand>();
  CLI::App* sub = app.add_subcommand("merge", "Make one session of several that overlap");
  sub->add_option("sessions", command->sessions,
                  "Session files (.glint), the first one's frame is kept; they are only read")
      ->required()
      ->expected(2, 1000);
  sub->add_option("--out", command->out, "Session file to write")->required();
  sub->add_flag("--force", command->force, "Replace the file if it is there");
  sub->add_flag("--json", command->json, "Print what was done as a JSON object");
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
