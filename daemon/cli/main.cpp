// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint: captures and clients of the daemon, one sub-command a file in this folder.
#include <exception>
#include <iostream>

#include "daemon/cli/command.hpp"
#include "daemon/version.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

int report(const std::exception& error, ExitCode code) {
  std::cerr << "glint: " << error.what() << '\n';
  return code;
}

int run(int argc, char** argv) {
  CLI::App app{"Glint: Ouster lidar SLAM. Captures, simulation, and clients of glintd.", "glint"};
  app.set_version_flag("--version", std::string("glint ") + kVersion);
  app.require_subcommand(1);
  add_replay(app);
  add_dump(app);
  add_info(app);
  add_simulate(app);
  add_train_vocabulary(app);
  add_emulate(app);
  add_record(app);
  add_doctor(app);
  add_config(app);
  add_status(app);
  add_metrics(app);
  add_pose(app);
  add_watch(app);
  add_map(app);
  add_maps(app);
  add_merge(app);
  add_load(app);
  add_relocalize(app);
  add_trajectory(app);
  add_control(app);
  add_wait(app);
  add_save(app);
  add_delete_map(app);
  add_export(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  } catch (const UsageError& error) {
    return report(error, kUsage);
  } catch (const InputError& error) {
    return report(error, kBadInput);
  } catch (const ConnectionError& error) {
    return report(error, kNoDaemon);
  } catch (const std::exception& error) {
    return report(error, kFailed);
  }
  return kDone;
}

}  // namespace
}  // namespace glint::cli

// What escapes run() was thrown while it reported something: there is no more to tell than that.
int main(int argc, char** argv) try { return glint::cli::run(argc, argv); } catch (...) {
  return glint::cli::kFailed;
}
