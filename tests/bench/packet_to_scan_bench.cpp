// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Packets to scans, per packet, beside memcpy of the same bytes into a ring the size of a scan. The
// packets are random in every field; those of one pass are longer than the caches ("streaming") or
// a few scans that stay in them ("hot").
#include <benchmark/benchmark.h>

#include "driver/core/column_decoder.hpp"
#include "driver/core/scan_assembler.hpp"
#include "tests/bench/packet_ring.hpp"

namespace glint {
namespace {

using bench::kHotBytes;
using bench::kStreamingBytes;
using bench::PacketRing;

constexpr int kColumns = 1024;

void report(benchmark::State& state, const PacketRing& ring) {
  const auto packets = static_cast<double>(state.iterations()) * static_cast<double>(ring.size());
  state.counters["s_per_packet"] =
      benchmark::Counter(packets, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void assemble(benchmark::State& state, LidarProfile profile, int rows, std::size_t bytes) {
  const SensorInfo info = test::make_sensor(profile, rows, kColumns);
  PacketRing ring(info, bytes);
  ScanAssembler assembler(info);
  std::uint64_t scans = 0;
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    for (std::size_t i = 0; i < ring.size(); ++i) {
      assembler.push(ring.packet(i));
      while (const LidarScan* scan = assembler.next()) {
        benchmark::DoNotOptimize(scan->range_mm.data.data());
        ++scans;
      }
    }
    state.PauseTiming();
    ring.renumber();
    state.ResumeTiming();
  }
  if (assembler.counters().incomplete_scans != 0 || scans == 0) {
    state.SkipWithError("packets were lost");
  }
  report(state, ring);
}

void copy(benchmark::State& state, LidarProfile profile, int rows, std::size_t bytes) {
  const SensorInfo info = test::make_sensor(profile, rows, kColumns);
  const PacketRing ring(info, bytes);
  test::Bytes scan;
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    ring.copy_to(scan);
  }
  report(state, ring);
}

void decode(benchmark::State& state, LidarProfile profile, int rows, std::size_t bytes,
            DecoderPath path) {
  const PacketRing ring(test::make_sensor(profile, rows, kColumns), bytes);
  const PacketFormat& format = ring.format();
  const DecodeColumns decode_columns = column_decoder(profile, path);
  const int header = format.layout->packet_header_bytes + format.layout->column_header_bytes;
  LidarScan scan(format);
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int column = static_cast<int>(i % ring.packets_per_scan()) * format.columns_per_packet;
      decode_columns(format, ring.packet(i).data() + header, format.columns_per_packet, column,
                     scan);
    }
    benchmark::DoNotOptimize(scan.range_mm.data.data());
  }
  report(state, ring);
}

// Named parameters of the runs: legacy as the OS1-64 sends it, and 128 beams of the later profile.
constexpr auto kLegacy = LidarProfile::kLegacy;
constexpr auto kSingle = LidarProfile::kRng19Rfl8Sig16Nir16;

BENCHMARK_CAPTURE(assemble, legacy_64_streaming, kLegacy, 64, kStreamingBytes);
BENCHMARK_CAPTURE(copy, legacy_64_streaming, kLegacy, 64, kStreamingBytes);
BENCHMARK_CAPTURE(assemble, legacy_64_hot, kLegacy, 64, kHotBytes);
BENCHMARK_CAPTURE(copy, legacy_64_hot, kLegacy, 64, kHotBytes);
BENCHMARK_CAPTURE(assemble, rng19_128_streaming, kSingle, 128, kStreamingBytes);
BENCHMARK_CAPTURE(copy, rng19_128_streaming, kSingle, 128, kStreamingBytes);
BENCHMARK_CAPTURE(assemble, rng19_128_hot, kSingle, 128, kHotBytes);
BENCHMARK_CAPTURE(assemble, low_rate_128_streaming, LidarProfile::kRng15Rfl8Nir8, 128,
                  kStreamingBytes);
BENCHMARK_CAPTURE(assemble, dual_64_streaming, LidarProfile::kRng19Rfl8Sig16Nir16Dual, 64,
                  kStreamingBytes);

constexpr auto kPortable = DecoderPath::kPortable;
constexpr auto kFastest = DecoderPath::kFastest;
BENCHMARK_CAPTURE(decode, legacy_64_hot, kLegacy, 64, kHotBytes, kFastest);
BENCHMARK_CAPTURE(decode, legacy_64_hot_portable, kLegacy, 64, kHotBytes, kPortable);
BENCHMARK_CAPTURE(decode, legacy_64_streaming, kLegacy, 64, kStreamingBytes, kFastest);
BENCHMARK_CAPTURE(decode, legacy_64_streaming_portable, kLegacy, 64, kStreamingBytes, kPortable);

}  // namespace
}  // namespace glint

BENCHMARK_MAIN();
