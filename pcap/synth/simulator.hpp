// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "pcap/synth/option_error.hpp"
#include "pcap/synth/sensor_model.hpp"
#include "pcap/synth/world.hpp"

namespace glint::synth {

struct SimulationOptions {
  std::string world = "corridor";
  double seconds = 30.0;
  std::uint64_t seed = 1;
  SensorOptions sensor;  ///< Its seed is replaced by `seed`.
  int threads = 2;       ///< Does not change the result.
};

/// What is true of one simulated scan.
struct ScanTruth {
  std::uint16_t frame_id = 0;
  SensorTime start;     ///< Time of its first column.
  Pose T_world_sensor;  ///< At that time.
  /// Directions along which the geometry in view tells nothing, unit vectors in the sensor frame.
  std::vector<Eigen::Vector3d> blind_axes;
  double moving_share = 0.0;  ///< Of the points, on moving things.
};

/// Drives a simulated sensor through a world: every column is cast at its own time and pose.
/// Deterministic by seed. Thread-compatible.
class Simulator {
 public:
  /// @throws OptionError for an unknown world or an impossible sensor.
  explicit Simulator(const SimulationOptions& options);

  [[nodiscard]] const SensorInfo& info() const { return info_; }
  [[nodiscard]] const Scene& scene() const { return world_.scene; }
  [[nodiscard]] int scan_count() const { return scan_count_; }
  /// T_world_sensor at a sensor time.
  [[nodiscard]] Pose true_pose(SensorTime time) const;
  /// Time of a column, counted from the first of the run.
  [[nodiscard]] SensorTime column_time(std::int64_t column) const;

  /// The next scan and what is true of it; false after the last one. `scan` is reused.
  bool next(LidarScan& scan, ScanTruth& truth);

 private:
  void cast_columns(int first, int last, LidarScan& scan, Eigen::Matrix3d& information) const;

  const SimulationOptions options_;
  const SensorInfo info_;
  const World world_;
  const XyzLut lut_;
  const SensorModel model_;
  const int scan_count_;
  int next_scan_ = 0;
};

/// The packets of a simulation, in memory: for tests and for feeding the pipeline directly.
class SyntheticSource : public PacketSource {
 public:
  explicit SyntheticSource(const SimulationOptions& options);
  ~SyntheticSource() override;
  SourceStatus read(RawPacket& packet) override;
  void stop() override;
  [[nodiscard]] const Simulator& simulator() const;
  /// What is true of the scans begun so far.
  [[nodiscard]] const std::vector<ScanTruth>& truth() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes `capture.pcap`, `metadata.json`, `groundtruth.tum` (scan starts), `groundtruth_100hz.tum`
/// and `truth.jsonl` into a directory, which is created. @throws OptionError, or InputError if
/// something cannot be written; then no capture is left.
void simulate(const SimulationOptions& options, const std::filesystem::path& directory);

}  // namespace glint::synth
