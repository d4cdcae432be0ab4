// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Front end: time per scan at 64x1024 and of each of its stages, on a simulated corridor.
#include <benchmark/benchmark.h>

#include <ctime>
#include <string>
#include <vector>

#include "driver/core/scan_assembler.hpp"
#include "pcap/synth/synthetic_source.hpp"
#include "slam/frontend.hpp"

namespace glint {
namespace {

std::int64_t read_clock_ns(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return std::int64_t{t.tv_sec} * kNsPerSecond + t.tv_nsec;
}

const Clock kClock{[] { return read_clock_ns(CLOCK_MONOTONIC); },
                   [] { return read_clock_ns(CLOCK_THREAD_CPUTIME_ID); }};

struct Walk {
  SensorInfo info;
  std::vector<LidarScan> scans;
};

const Walk& corridor() {
  static const Walk kWalk = [] {
    synth::SimulationOptions options;
    options.world = "corridor";
    options.seconds = 6.0;
    synth::SyntheticSource source(options);
    Walk walk{source.simulator().info(), {}};
    ScanAssembler assembler(walk.info);
    RawPacket packet;
    while (source.read(packet) == SourceStatus::kPacket) {
      static_cast<void>(assembler.push(packet.bytes));
      while (const LidarScan* scan = assembler.next()) walk.scans.push_back(*scan);
    }
    return walk;
  }();
  return kWalk;
}

void BM_FrontEnd(benchmark::State& state, const char* preset) {
  const Walk& walk = corridor();
  slam::Frontend frontend(walk.info, slam::preset_config(preset), kClock);
  slam::StageTimes sum;
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(frontend.process(walk.scans[next]));
    next = (next + 1) % walk.scans.size();
    for (std::size_t i = 0; i < slam::kStageCount; ++i) {
      sum.cpu_ns[i] += frontend.stage_times().cpu_ns[i];
    }
  }
  for (const slam::Stage stage : {slam::Stage::kImage, slam::Stage::kFeatures,
                                  slam::Stage::kMatching, slam::Stage::kRegistration}) {
    const auto i = static_cast<std::size_t>(stage);
    state.counters[std::string(slam::kStageNames[i]) + "_ms"] = benchmark::Counter(
        1e-6 * static_cast<double>(sum.cpu_ns[i]), benchmark::Counter::kAvgIterations);
  }
}

BENCHMARK_CAPTURE(BM_FrontEnd, paper, "paper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FrontEnd, full, "full")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glint
