// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcap/synth/blind_axes.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

constexpr std::int64_t kClockStartNs = 1'000 * kNsPerSecond;
// The motor's speed swings by these shares, over so many revolutions.
struct Swing {
  double share;
  double revolutions;
};
constexpr std::array<Swing, 2> kSwings = {{{0.002, 5.3}, {0.003, 0.97}}};

// Columns that one call of the executor casts.
constexpr int kBlockColumns = 32;
// Every so manieth column and row is looked at for the blind axes.
constexpr int kNormalStep = 4;

int scans_in(const SimulationOptions& options) {
  if (!(options.seconds > 0.0 && options.seconds <= 1e6)) {
    throw OptionError("the duration must be above 0 and at most 1000000 seconds");
  }
  return std::max(1, static_cast<int>(std::lround(options.seconds * options.sensor.rate_hz)));
}

// When the sensor was switched on does not fall on a whole second.
SensorTime start_of(std::uint64_t seed) {
  Random random{seed, 0xC10CULL};
  return {kClockStartNs + random.below(static_cast<int>(kNsPerSecond))};
}

}  // namespace

Simulator::Simulator(const SimulationOptions& options)
    : options_(options),
      info_(make_sensor(options.sensor, options.seed)),
      world_(make_world(options.world, options.seed)),
      lut_(info_),
      model_(info_, options.noise, options.seed),
      scan_count_(scans_in(options)),
      start_(start_of(options.seed)) {}

Pose Simulator::true_pose(SensorTime time) const {
  return world_.motion.at(static_cast<double>(time - start_) * kSecondsPerNs);
}

SensorTime Simulator::column_time(std::int64_t column) const {
  const double revolutions = static_cast<double>(column) / info_.columns_per_frame;
  double turned = revolutions;
  for (const Swing& swing : kSwings) {
    const double rate = 2.0 * std::numbers::pi / swing.revolutions;
    turned += swing.share / rate * std::sin(rate * revolutions);
  }
  return start_ + std::llround(static_cast<double>(info_.scan_period_ns()) * turned);
}

void Simulator::set_header(LidarScan& scan) const {
  const int columns = info_.columns_per_frame;
  scan.sequence = static_cast<std::uint64_t>(next_scan_);
  scan.frame_id = static_cast<std::uint16_t>(options_.sensor.first_frame_id + next_scan_);
  for (int m = 0; m < columns; ++m) {
    const auto column = static_cast<std::size_t>(m);
    scan.column_time[column] = column_time(std::int64_t{next_scan_} * columns + m);
    scan.column_status[column] = info_.profile == LidarProfile::kLegacy ? 0xFFFFFFFFU : 1U;
  }
  scan.columns_expected = scan.columns_received = columns;
  scan.end_time = scan.column_time.back();
  scan.mid_time = scan.column_time[static_cast<std::size_t>(columns / 2)];
}

bool Simulator::next(LidarScan& scan, ScanTruth& truth) {
  if (next_scan_ >= scan_count_) return false;
  const int columns = info_.columns_per_frame;
  if (scan.range_mm.cols != columns) scan = LidarScan(PacketFormat(info_));
  set_header(scan);

  const int normals_in_column = info_.pixels_per_column / kNormalStep;
  std::vector<Eigen::Vector3d> normals(
      static_cast<std::size_t>(columns / kNormalStep) * static_cast<std::size_t>(normals_in_column),
      Eigen::Vector3d::Zero());
  options_.parallel_for(columns / kBlockColumns, [&](int block) {
    for (int m = block * kBlockColumns; m < (block + 1) * kBlockColumns; ++m) {
      cast_column(m, scan, normals);
    }
  });

  truth.scan = next_scan_;
  truth.frame_id = scan.frame_id;
  truth.start = scan.column_time.front();
  truth.T_world_sensor = true_pose(truth.start);
  truth.moving_share = 0.0;
  truth.blind_axes = blind_axes(normals);
  for (Eigen::Vector3d& axis : truth.blind_axes) {
    axis = truth.T_world_sensor.rotation.conjugate() * axis;
  }
  ++next_scan_;
  return true;
}

void Simulator::cast_column(int m, LidarScan& scan, std::vector<Eigen::Vector3d>& normals) const {
  const Pose T_world_sensor = true_pose(scan.column_time[static_cast<std::size_t>(m)]);
  // Ranges count from where the ray meets the offset, so that a decoded point is offset + range *
  // direction. The table's directions are per millimetre.
  const Eigen::Matrix3d rotation = T_world_sensor.rotation.toRotationMatrix();
  const Eigen::Matrix3d unit_rotation = 1000.0 * rotation;
  const std::uint64_t column = scan.sequence * static_cast<std::uint64_t>(info_.columns_per_frame) +
                               static_cast<std::uint64_t>(m);
  for (int row = 0; row < info_.pixels_per_column; ++row) {
    const Ray ray{rotation * lut_.offset(row, m) + T_world_sensor.translation_m,
                  unit_rotation * lut_.direction(row, m)};
    const auto sighting = world_.scene.cast(ray);
    const Measurement measured = model_.measure(sighting, ray.direction, row,
                                                column << 8U | static_cast<std::uint64_t>(row));
    scan.range_mm(row, m) = measured.range_mm;
    if (!scan.signal.empty()) scan.signal(row, m) = measured.signal;
    scan.reflectivity(row, m) = measured.reflectivity;
    scan.near_ir(row, m) = measured.near_ir;
    if (m % kNormalStep == 0 && row % kNormalStep == 0 && measured.range_mm > 0) {
      const int index =
          m / kNormalStep * (info_.pixels_per_column / kNormalStep) + row / kNormalStep;
      normals[static_cast<std::size_t>(index)] = sighting->hit.normal;
    }
  }
}

}  // namespace glint::synth
