// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Packets to scans, per packet, beside memcpy of the same bytes into a ring the size of a scan. The
// packets are random in every field; those of one pass are longer than the caches ("streaming") or
// a few scans that stay in them ("hot").
#include <benchmark/benchmark.h>

#include <cstring>
#include <random>

#include "driver/core/bytes.hpp"
#include "driver/core/profile_table.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

constexpr std::size_t kStreamingBytes = 64U << 20U;
constexpr std::size_t kHotBytes = 3U << 20U;
constexpr int kColumns = 1024;

// A run of scans' packets in one block of memory, played again and again with ever newer ids.
class PacketRing {
 public:
  PacketRing(const SensorInfo& info, std::size_t bytes) : format_(info) {
    std::mt19937 random(1);
    const auto packets = test::encode(info, test::random_scan(info, 0, random));
    while (bytes_.size() < bytes) {
      for (const test::Bytes& packet : packets) {
        bytes_.insert(bytes_.end(), packet.begin(), packet.end());
      }
      ++scans_;
    }
    packets_per_scan_ = packets.size();
    renumber();
  }

  [[nodiscard]] std::size_t size() const { return scans_ * packets_per_scan_; }
  [[nodiscard]] std::span<const std::byte> packet(std::size_t index) const {
    return {bytes_.data() + index * format_.packet_bytes, format_.packet_bytes};
  }

  /// Gives the scans the frame ids and times after those they had.
  void renumber() {
    for (std::size_t i = 0; i < size(); ++i) {
      const std::uint64_t scan = first_scan_ + i / packets_per_scan_;
      std::byte* packet = bytes_.data() + i * format_.packet_bytes;
      const auto frame_id = static_cast<std::uint16_t>(scan);
      if (!format_.legacy()) store(packet + kStandardHeader.frame_id_offset, frame_id);
      for (int c = 0; c < format_.columns_per_packet; ++c) {
        std::byte* column = packet + format_.layout->packet_header_bytes +
                            static_cast<std::size_t>(c) * format_.column_bytes;
        store(column + kColumnTimeOffset, std::uint64_t{1'000'000'000} + scan * 100'000'000U);
        if (format_.legacy()) store(column + kLegacyFrameIdOffset, frame_id);
      }
    }
    first_scan_ += scans_;
  }

 private:
  PacketFormat format_;
  test::Bytes bytes_;
  std::size_t packets_per_scan_ = 0;
  std::uint64_t scans_ = 0;
  std::uint64_t first_scan_ = 0;
};

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
  const std::size_t packet_bytes = ring.packet(0).size();
  const std::size_t slots = kColumns / static_cast<std::size_t>(info.columns_per_packet);
  test::Bytes scan(packet_bytes * slots);
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    for (std::size_t i = 0; i < ring.size(); ++i) {
      std::memcpy(scan.data() + i % slots * packet_bytes, ring.packet(i).data(), packet_bytes);
      benchmark::ClobberMemory();
    }
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

}  // namespace
}  // namespace glint

BENCHMARK_MAIN();
