// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Simulator: time per scan on one core, and how much faster than the sensor that is.
#include <benchmark/benchmark.h>

#include <string>

#include "pcap/synth/synthetic_source.hpp"

namespace glint {
namespace {

void BM_Simulator(benchmark::State& state, const std::string& world, int beams) {
  synth::SimulationOptions options;
  options.world = world;
  options.seconds = 1e6;
  options.sensor.beams = beams;
  synth::SyntheticSource source(options);
  RawPacket packet;
  for (auto _ : state) {
    for (const int scan = source.truth().scan; source.truth().scan == scan;) source.read(packet);
  }
  state.counters["times_real"] =
      benchmark::Counter(static_cast<double>(state.iterations()) / options.sensor.rate_hz,
                         benchmark::Counter::kIsRate);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  for (const glint::synth::WorldEntry& world : glint::synth::world_list()) {
    for (const int beams : {64, 128}) {
      const std::string name = std::string(world.name);
      benchmark::RegisterBenchmark(
          (name + "/" + std::to_string(beams)).c_str(),
          [name, beams](benchmark::State& state) { glint::BM_Simulator(state, name, beams); })
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
