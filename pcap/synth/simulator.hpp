// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/packet_writer.hpp"
#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "pcap/synth/option_error.hpp"
#include "pcap/synth/parallel.hpp"
#include "pcap/synth/sensor_model.hpp"
#include "pcap/synth/sensor_options.hpp"
#include "pcap/synth/world.hpp"

// Simulated sensors with known truth. Three ways in:
//
//   Simulator           scans and truth, no packets:
//       synth::Simulator simulator({.world = "room", .seconds = 10});
//       LidarScan scan;
//       synth::ScanTruth truth;
//       while (simulator.next(scan, truth)) use(scan, truth.T_world_sensor);
//
//   SyntheticSource     packets in memory, through the interface that live and replay share:
//       synth::SyntheticSource source({.world = "corridor"});
//       ScanAssembler assembler(source.simulator().info());
//       RawPacket packet;
//       while (source.read(packet) == SourceStatus::kPacket) assembler.push(packet.bytes);
//
//   simulate()          a capture with its metadata and ground truth on disk.
namespace glint::synth {

/// What to simulate. Everything follows from these values: the same options give the same bytes,
/// whatever `parallel_for` does; another seed gives another layout, walk, sensor and noise.
struct SimulationOptions {
  std::string world = "corridor";  ///< One of world_names().
  double seconds = 30.0;           ///< Rounded to whole scans, at least one.
  std::uint64_t seed = 1;
  SensorOptions sensor;
  NoiseOptions noise;
  ParallelFor parallel_for = serial_for;
};

/// What is true of one simulated scan.
struct ScanTruth {
  int scan = 0;                ///< Counts from 0.
  std::uint16_t frame_id = 0;  ///< As on the wire.
  SensorTime start;            ///< Time of its first column.
  Pose T_world_sensor;         ///< At that time.
  /// Directions along which the geometry in view tells nothing, unit vectors in the sensor frame.
  std::vector<Eigen::Vector3d> blind_axes;
  double moving_share = 0.0;  ///< Of the points, on moving things.
};

/// Carries a simulated sensor through a world: every column is cast at its own time and pose, along
/// the very rays that decoding assumes. Deterministic by seed. Thread-compatible.
class Simulator {
 public:
  /// @throws OptionError for an unknown world or an impossible sensor or duration.
  explicit Simulator(const SimulationOptions& options);

  [[nodiscard]] const SensorInfo& info() const { return info_; }
  [[nodiscard]] const Scene& scene() const { return world_.scene; }
  [[nodiscard]] int scan_count() const { return scan_count_; }
  /// T_world_sensor at a sensor time.
  [[nodiscard]] Pose true_pose(SensorTime time) const;
  /// Time of a column, counted from the first of the run.
  [[nodiscard]] SensorTime column_time(std::int64_t column) const;

  /// The next scan (staggered) and what is true of it; false after the last one. `scan` is reused.
  bool next(LidarScan& scan, ScanTruth& truth);

 private:
  void set_header(LidarScan& scan) const;
  void cast_column(int column, LidarScan& scan, std::vector<Eigen::Vector3d>& normals) const;

  const SimulationOptions options_;
  const SensorInfo info_;
  const World world_;
  const XyzLut lut_;
  const SensorModel model_;
  const int scan_count_;
  const SensorTime start_;
  int next_scan_ = 0;
};

/// The packets of a simulation, in memory: for tests and for feeding the pipeline directly. Each
/// arrives a little after its last column, by a host clock with a fixed epoch.
class SyntheticSource final : public PacketSource {
 public:
  /// @throws OptionError as Simulator does.
  explicit SyntheticSource(const SimulationOptions& options);
  SourceStatus read(RawPacket& packet) override;
  void stop() override { stopped_ = true; }
  [[nodiscard]] const Simulator& simulator() const { return simulator_; }
  /// What is true of the scans begun so far.
  [[nodiscard]] const std::vector<ScanTruth>& truth() const { return truth_; }

 private:
  const std::uint64_t seed_;
  Simulator simulator_;
  const PacketWriter writer_;
  LidarScan scan_;
  std::vector<ScanTruth> truth_;
  int next_packet_ = -1;  ///< Of `scan_`; -1 when the next scan is to be cast.
  std::atomic<bool> stopped_ = false;
};

/// Writes into a directory, which is made if need be:
///   capture.pcap           what the sensor sent
///   metadata.json          what it says of itself
///   groundtruth.tum        T_world_sensor at each scan's first column: t x y z qx qy qz qw
///   groundtruth_100hz.tum  the same every 10 ms
///   truth.jsonl            a line a scan: scan, frame_id, t_ns, t, blind_axes, moving_share,
///                          earlier_scans_within_2m: runs [first, last] of `scan` that are at least
///                          10 m of way older
/// Times are sensor times. The files get their names at the end, the capture last: what stops
/// half-way leaves nothing that looks whole. `progress(done, all)` follows the scans.
/// @throws InputError if something cannot be written, OptionError as Simulator does.
void simulate(const SimulationOptions& options, const std::filesystem::path& directory,
              const std::function<void(int done, int all)>& progress = {});

}  // namespace glint::synth
