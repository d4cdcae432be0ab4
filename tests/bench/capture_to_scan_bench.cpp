// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A capture in the page cache to scans, per scan of 64x1024 legacy packets: datagrams whole, as a
// capture off a loopback or offloading card has them, and in IP fragments, as one off a cable has.
#include <benchmark/benchmark.h>

#include "tests/bench/capture_on_disk.hpp"

namespace glint {
namespace {

void replay(benchmark::State& state, int mtu) {
  const SensorInfo info = test::make_sensor(LidarProfile::kLegacy, 64, 1024);
  const bench::PacketRing ring(info, 2 * bench::kStreamingBytes);
  const bench::CaptureOnDisk capture(info, ring, mtu);
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    if (capture.replay() != ring.scans()) state.SkipWithError("packets were lost");
  }
  state.counters["s_per_scan"] =
      benchmark::Counter(static_cast<double>(state.iterations() * ring.scans()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(replay, whole_datagrams, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, fragments, 1500)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glint

BENCHMARK_MAIN();
