// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <vector>

#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/packet_writer.hpp"
#include "pcap/synth/simulator.hpp"

namespace glint::synth {

/// The packets of a simulated sensor, lidar and IMU, in memory: for tests, the wire and the daemon.
/// Each arrives a little after its last measurement, by a host clock with a fixed epoch that runs
/// true.
///
///     SyntheticSource source({.world = "corridor"});
///     ScanAssembler assembler(source.simulator().info());
///     RawPacket packet;
///     while (source.read(packet) == SourceStatus::kPacket) assembler.push(packet.bytes);
class SyntheticSource final : public PacketSource {
 public:
  /// Whether a packet that arrives at this time is due; waits for it, but not long.
  using Pacer = std::function<bool(HostTime)>;

  /// Without a pacer packets come as fast as they are made. @throws as Simulator does.
  explicit SyntheticSource(const SimulationOptions& options, Pacer pacer = {});
  SourceStatus read(RawPacket& packet) override;
  void stop() override { stopped_ = true; }
  [[nodiscard]] const Simulator& simulator() const { return simulator_; }
  /// What is true of the scan that was begun last.
  [[nodiscard]] const ScanTruth& truth() const { return truth_; }
  [[nodiscard]] const FaultCounts& faults() const { return network_.counts(); }

 private:
  SourceStatus send(RawPacket& packet);
  bool next_lidar();
  void next_imu();
  [[nodiscard]] bool silent(double true_s) const;
  [[nodiscard]] HostTime arrival(double true_s, std::uint64_t kind) const;

  const SimulationOptions options_;
  Simulator simulator_;
  ImuModel imu_;
  FaultyNetwork network_;
  const Pacer pacer_;
  const std::array<PacketWriter, 2> writers_;  ///< Before the sensor's restart and after it.
  std::array<ImuPacketWriter, 2> imu_writers_;
  LidarScan scan_;
  ScanTruth truth_;
  std::vector<ImuSample> imu_samples_;  ///< Of the packet that is due next.
  int next_packet_ = -1;                ///< Of `scan_`; -1 when the next scan is to be cast.
  std::int64_t next_sample_ = 0;
  RawPacket lidar_packet_;  ///< Waiting to be sent; empty: to be made.
  RawPacket imu_packet_;
  RawPacket waiting_;  ///< Not yet due.
  std::atomic<bool> stopped_ = false;
};

}  // namespace glint::synth
