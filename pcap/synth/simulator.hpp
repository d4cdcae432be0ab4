// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "pcap/synth/option_error.hpp"
#include "pcap/synth/sensor/sensor_model.hpp"
#include "pcap/synth/sensor/timing.hpp"
#include "pcap/synth/simulation_options.hpp"
#include "pcap/synth/worlds/world.hpp"

// Simulated sensors with known truth. Three ways in:
//
//   Simulator           scans and truth, no packets:
//       synth::Simulator simulator({.world = "room", .seconds = 10});
//       LidarScan scan;
//       synth::ScanTruth truth;
//       while (simulator.next(scan, truth)) use(scan, truth.T_world_sensor);
//
//   SyntheticSource     packets in memory, through the interface that live and replay share
//                       (synthetic_source.hpp)
//
//   simulate()          a capture with its metadata and ground truth on disk (truth_files.hpp)
namespace glint::synth {

/// Pixels of one row that lie on a moving thing: columns first to last (staggered).
struct MovingRun {
  int row = 0;
  int first_column = 0;
  int last_column = 0;
};

/// What is true of one simulated scan.
struct ScanTruth {
  int scan = -1;               ///< Counts revolutions from 0, those of a restart's silence too.
  std::uint16_t frame_id = 0;  ///< As on the wire.
  bool restarted = false;      ///< Made after the sensor's restart.
  SensorTime start;            ///< Time of its first column.
  Pose T_world_sensor;         ///< At that time.
  /// Directions along which the geometry in view tells nothing, unit vectors in the sensor frame.
  std::vector<Eigen::Vector3d> blind_axes;
  double moving_share = 0.0;  ///< Of the points, on moving things.
  std::vector<MovingRun> moving;
};

/// Carries a simulated sensor through a world: every column is cast at its own time and pose, along
/// the very rays that decoding assumes. Deterministic by seed. Thread-compatible.
class Simulator {
 public:
  /// @throws OptionError for an unknown world, motion, or an impossible sensor or duration;
  /// InputError for a trajectory file that cannot be used.
  explicit Simulator(const SimulationOptions& options);

  [[nodiscard]] const SensorInfo& info() const { return info_; }
  [[nodiscard]] const Scene& scene() const { return world_.scene; }
  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] const Timing& timing() const { return timing_; }
  [[nodiscard]] int scan_count() const { return scan_count_; }
  /// T_world_sensor at a sensor time.
  [[nodiscard]] Pose true_pose(SensorTime time) const { return motion_(timing_.true_s(time)); }

  /// The next scan (staggered) and what is true of it; false after the last one. Both are reused.
  bool next(LidarScan& scan, ScanTruth& truth);

 private:
  struct Casting;

  [[nodiscard]] int first_scan_from(double true_s) const;
  void set_header(LidarScan& scan, ScanTruth& truth) const;
  struct Column;

  [[nodiscard]] Column column_at(int m, const LidarScan& scan) const;
  void cast_columns(int first, Casting& casting) const;
  [[nodiscard]] Measurement measure(const Column& column, const Ray& ray, const Sighting& sighting,
                                    int row, std::uint64_t pixel_key) const;
  void set_pixel(const Column& column, const Ray& ray, const Sighting& sighting, int row,
                 Casting& casting) const;

  const SimulationOptions options_;
  const SensorInfo info_;
  const World world_;
  const Motion motion_;
  const XyzLut lut_;
  const SensorModel model_;
  const Timing timing_;
  const int scan_count_;
  const int first_silent_scan_;  ///< The sensor restarts; scan_count_ if it never does.
  const int restart_scan_;       ///< The first one after that.
  int next_scan_ = 0;
};

}  // namespace glint::synth
