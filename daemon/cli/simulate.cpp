// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint simulate: a capture with ground truth from a simulated sensor in a simulated world.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/cli/command.hpp"
#include "driver/core/error.hpp"
#include "pcap/synth/simulator.hpp"

namespace glint::cli {
namespace {

struct SimulateOptions {
  synth::SimulationOptions simulation;
  std::string profile = "RNG19_RFL8_SIG16_NIR16";
  std::string out;
  int threads = 2;
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

/// Shares the calls among `threads` threads, the caller's among them.
synth::ParallelFor parallel_for(int threads) {
  return [threads](int count, const std::function<void(int)>& work) {
    std::atomic<int> next = 0;
    const auto take = [&] {
      for (int i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::jthread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back(take);
    take();
  };
}

void show_progress(int done, int all) {
  std::cerr << fmt::format("\rscan {} of {}", done, all) << (done == all ? "\n" : "") << std::flush;
}

void run(const SimulateOptions& options) {
  synth::SimulationOptions simulation = options.simulation;
  simulation.sensor.profile = profiles().at(options.profile);
  simulation.parallel_for = parallel_for(options.threads);
  std::function<void(int, int)> progress;
  if (isatty(STDERR_FILENO) != 0) progress = show_progress;
  try {
    synth::simulate(simulation, options.out, progress);
  } catch (const synth::OptionError& error) {
    throw UsageError(error.what());
  }
  std::cout << fmt::format("{}, {} s, seed {}: capture, metadata and ground truth in {}\n",
                           simulation.world, simulation.seconds, simulation.seed, options.out);
}

}  // namespace

void add_simulate(CLI::App& app) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* const command =
      app.add_subcommand("simulate", "Write a capture with ground truth of a simulated sensor");
  synth::SimulationOptions& simulation = options->simulation;
  std::vector<std::string> names;
  for (const auto& [name, profile] : profiles()) names.push_back(name);
  command
      ->add_option("--world", simulation.world,
                   fmt::format("Where: {}", fmt::join(synth::world_names(), ", ")))
      ->required();
  command->add_option("--seconds", simulation.seconds, "How long, s")->capture_default_str();
  command->add_option("--seed", simulation.seed, "Layout, walk, sensor and noise follow from it")
      ->capture_default_str();
  command->add_option("--profile", options->profile, "What the packets hold")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command->add_option("--out", options->out, "Directory for the files, made if need be")
      ->required();
  command->add_option("--sensor", simulation.sensor.optics, "os0, os1 or os2")
      ->capture_default_str();
  command->add_option("--beams", simulation.sensor.beams, "16, 32, 64 or 128")
      ->capture_default_str();
  command->add_option("--columns", simulation.sensor.columns, "512, 1024 or 2048")
      ->capture_default_str();
  command->add_option("--rate", simulation.sensor.rate_hz, "Scans a second: 10 or 20")
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads to cast with; the bytes are the same")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace glint::cli
