// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// glint simulate: a capture with ground truth from a simulated sensor in a simulated world.
#include <iostream>
#include <map>
#include <memory>

#include "daemon/cli/command.hpp"
#include "driver/core/error.hpp"
#include "pcap/synth/simulator.hpp"

namespace glint::cli {
namespace {

struct SimulateCommand {
  synth::SimulationOptions options;
  std::string profile = "RNG19_RFL8_SIG16_NIR16";
  std::string out;
};

const std::map<std::string, LidarProfile>& profiles() {
  static const std::map<std::string, LidarProfile> kProfiles = [] {
    std::map<std::string, LidarProfile> by_name;
    for (const LidarProfile profile :
         {LidarProfile::kLegacy, LidarProfile::kRng19Rfl8Sig16Nir16,
          LidarProfile::kRng19Rfl8Sig16Nir16Dual, LidarProfile::kRng15Rfl8Nir8}) {
      by_name.emplace(to_string(profile), profile);
    }
    return by_name;
  }();
  return kProfiles;
}

void run(SimulateCommand& command) {
  command.options.sensor.profile = profiles().at(command.profile);
  try {
    synth::simulate(command.options, command.out);
  } catch (const synth::OptionError& error) {
    throw UsageError(error.what());
  }
  std::cout << command.options.world << ", " << command.options.seconds
            << " s: capture and truth in " << command.out << '\n';
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto command = std::make_shared<SimulateCommand>();
  CLI::App* sub = app.add_subcommand("simulate", "Make a capture with ground truth");
  std::string worlds;
  for (const std::string_view world : synth::world_names()) {
    worlds += (worlds.empty() ? "" : ", ") + std::string(world);
  }
  std::vector<std::string> names;
  for (const auto& [name, profile] : profiles()) names.push_back(name);
  synth::SimulationOptions& options = command->options;
  sub->add_option("--world", options.world, "One of: " + worlds)->required();
  sub->add_option("--seconds", options.seconds, "Length of the run, s");
  sub->add_option("--seed", options.seed, "Layout, motion and noise");
  sub->add_option("--profile", command->profile, "Packet profile")->check(CLI::IsMember(names));
  sub->add_option("--out", command->out, "Directory for the files")->required();
  sub->add_option("--sensor", options.sensor.optics, "os0, os1 or os2");
  sub->add_option("--beams", options.sensor.beams, "16, 32, 64 or 128");
  sub->add_option("--columns", options.sensor.columns, "512, 1024 or 2048");
  sub->add_option("--rate", options.sensor.rate_hz, "Scans a second: 10 or 20");
  sub->add_option("--threads", options.threads, "Threads to cast with; the result is the same")
      ->check(CLI::Range(1, 64));
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
