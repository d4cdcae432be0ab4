// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/random.hpp"
#include "pcap/synth/simulator.hpp"

namespace glint::synth {
namespace {

constexpr std::int64_t kHostMinusSensorNs = 1'700'000'000 * kNsPerSecond;
// From the end of a packet's last column until it is in the host's hands; the network adds up to as
// much as the second number.
constexpr std::int64_t kDelayNs = 350'000;
constexpr int kJitterNs = 150'000;

}  // namespace

SyntheticSource::SyntheticSource(const SimulationOptions& options)
    : seed_(options.seed), simulator_(options), writer_(simulator_.info()) {}

SourceStatus SyntheticSource::read(RawPacket& packet) {
  if (stopped_) return SourceStatus::kEnd;
  if (next_packet_ < 0) {
    ScanTruth truth;
    if (!simulator_.next(scan_, truth)) return SourceStatus::kEnd;
    truth_.push_back(std::move(truth));
    next_packet_ = 0;
  }
  writer_.write(scan_, next_packet_, packet.bytes);
  const SensorInfo& info = simulator_.info();
  const int last_column = (next_packet_ + 1) * info.columns_per_packet - 1;
  const SensorTime measured = scan_.column_time[static_cast<std::size_t>(last_column)];
  Random network{seed_, 0x9E7ULL, static_cast<std::uint64_t>(measured.ns)};
  packet.host_time = {measured.ns + kHostMinusSensorNs + kDelayNs + network.below(kJitterNs)};
  packet.port = static_cast<std::uint16_t>(info.lidar_port);
  if (++next_packet_ == writer_.packets_per_scan()) next_packet_ = -1;
  return SourceStatus::kPacket;
}

}  // namespace glint::synth
