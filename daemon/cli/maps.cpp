// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint maps: the sessions of a directory, a line each.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/cli/command.hpp"
#include "driver/core/error.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct MapsCommand {
  fs::path directory = ".";
  bool json = false;
};

std::vector<fs::path> sessions_in(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".glint") files.push_back(entry.path());
  }
  if (error) {
    throw InputError(fmt::format("cannot list {}: {}; name a directory with sessions in it",
                                 directory.string(), error.message()));
  }
  std::ranges::sort(files);
  return files;
}

// What is quick to find out: the file's pages are not all looked at.
Json describe(const fs::path& file) {
  Json out{{"file", file.string()}};
  try {
    const slam::SessionReader session(file, slam::SessionCheck::kVersion);
    double duration_s = 0.0;
    for (const slam::SessionSegment& segment : session.segments()) {
      duration_s += static_cast<double>(segment.last_stamp - segment.first_stamp) * kSecondsPerNs;
    }
    double way_m = 0.0;
    const auto poses = session.poses();
    for (std::size_t i = 1; i < poses.size(); ++i) {
      if (poses[i].segment != poses[i - 1].segment) continue;
      way_m +=
          (poses[i].T_map_sensor.translation_m - poses[i - 1].T_map_sensor.translation_m).norm();
    }
    out["bytes"] = fs::file_size(file);
    out["keyframes"] = poses.size();
    out["segments"] = session.segments().size();
    out["loops"] = session.loop_edges().size();
    out["way_m"] = way_m;
    out["duration_s"] = duration_s;
  } catch (const InputError& error) {
    out["error"] = error.what();
  }
  return out;
}

void print_line(const Json& session) {
  if (session.contains("error")) {
    fmt::print("{}\n", session["error"].get<std::string>());
    return;
  }
  fmt::print("{}: {} keyframes in {} segments, {} loops, {:.0f} m in {:.0f} s, {:.1f} MB\n",
             session["file"].get<std::string>(), session["keyframes"].get<std::size_t>(),
             session["segments"].get<std::size_t>(), session["loops"].get<std::size_t>(),
             session["way_m"].get<double>(), session["duration_s"].get<double>(),
             session["bytes"].get<double>() / 1e6);
}

void run(const MapsCommand& command) {
  Json all = Json::array();
  for (const fs::path& file : sessions_in(command.directory)) all.push_back(describe(file));
  if (command.json) {
    std::cout << all.dump() << '\n';
    return;
  }
  if (all.empty()) fmt::print("no sessions (*.glint) in {}\n", command.directory.string());
  for (const Json& session : all) print_line(session);
}

}  // namespace

void add_maps(CLI::App& app) {
  auto command = std::make_shared<MapsCommand>();
  CLI::App* sub = app.add_subcommand("maps", "List the sessions of a directory");
  sub->add_option("directory", command->directory, "Where to look (default: here)");
  sub->add_flag("--json", command->json, "One JSON array");
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
