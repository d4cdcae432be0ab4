// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/simulator.hpp"

#include <algorithm>
#include <cmath>

#include "pcap/synth/motion/trajectory_file.hpp"
#include "pcap/synth/scene/blind_axes.hpp"

namespace glint::synth {
namespace {

// Columns that one call of the executor casts.
constexpr int kBlockColumns = 32;
// Every so manieth column and row is looked at for the blind axes.
constexpr int kNormalStep = 4;

int scans_in(const SimulationOptions& options) {
  if (!(options.seconds > 0.0 && options.seconds <= 1e8)) {
    throw OptionError("the duration must be above 0 and at most 100000000 seconds");
  }
  const double scans = std::round(options.seconds * options.sensor.rate_hz);
  return static_cast<int>(std::max(1.0, scans));
}

Motion motion_for(const SimulationOptions& options, const World& world) {
  if (!options.trajectory.empty()) {
    return load_trajectory(options.trajectory, options.sensor.rate_hz).motion;
  }
  MotionOptions motion = options.motion;
  if (motion.kind.empty()) motion.kind = world.motion;
  return make_motion(world.route, motion, options.seed);
}

// Fills in share and runs from the pixels' flags.
void set_moving(const LidarScan& scan, const Image<std::uint8_t>& moving, ScanTruth& truth) {
  truth.moving.clear();
  std::size_t points = 0;
  std::size_t on_moving = 0;
  for (int row = 0; row < moving.rows; ++row) {
    for (int m = 0; m < moving.cols; ++m) {
      points += scan.range_mm(row, m) > 0 ? 1 : 0;
      if (moving(row, m) == 0) continue;
      ++on_moving;
      const bool goes_on = !truth.moving.empty() && truth.moving.back().row == row &&
                           truth.moving.back().last_column == m - 1;
      if (!goes_on) truth.moving.push_back({row, m, m});
      truth.moving.back().last_column = m;
    }
  }
  truth.moving_share =
      points > 0 ? static_cast<double>(on_moving) / static_cast<double>(points) : 0.0;
}

}  // namespace

// One scan in the making. Columns write to different places and may do so on different threads.
struct Simulator::Casting {
  LidarScan& scan;
  std::vector<Eigen::Vector3d> normals;  ///< Of every kNormalStep-th point.
  Image<std::uint8_t> moving;            ///< 1: on a moving thing.
};

// Where the sensor is while it measures a column.
struct Simulator::Column {
  int m;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d at_m;
  Scene::Moment moment;
};

Simulator::Simulator(const SimulationOptions& options)
    : options_(options),
      info_(make_sensor(options.sensor, options.seed)),
      world_(make_world({options.world, options.seed, options.photographs, options.traffic})),
      motion_(motion_for(options, world_)),
      lut_(info_),
      model_(info_, options.noise, options.seed),
      timing_(info_, options.seed),
      scan_count_(scans_in(options)),
      first_silent_scan_(first_scan_from(options.stream.restart_at_s)),
      restart_scan_(first_scan_from(options.stream.restart_at_s + options.stream.restart_gap_s)) {}

int Simulator::first_scan_from(double true_s) const {
  int scan = 0;
  if (options_.stream.restart_at_s <= 0.0) return scan_count_;
  while (scan < scan_count_ &&
         timing_.column_s(std::int64_t{scan} * info_.columns_per_frame) < true_s) {
    ++scan;
  }
  return scan;
}

void Simulator::set_header(LidarScan& scan, ScanTruth& truth) const {
  const int columns = info_.columns_per_frame;
  truth.restarted = next_scan_ >= restart_scan_;
  const int frame =
      truth.restarted ? next_scan_ - restart_scan_ : options_.sensor.first_frame_id + next_scan_;
  scan.sequence = static_cast<std::uint64_t>(next_scan_);
  scan.frame_id = static_cast<std::uint16_t>(frame);
  for (int m = 0; m < columns; ++m) {
    const auto column = static_cast<std::size_t>(m);
    scan.column_time[column] =
        timing_.clock_at(timing_.column_s(std::int64_t{next_scan_} * columns + m));
    scan.column_status[column] = info_.profile == LidarProfile::kLegacy ? 0xFFFFFFFFU : 1U;
  }
  scan.columns_expected = scan.columns_received = columns;
  scan.end_time = scan.column_time.back();
  scan.mid_time = scan.column_time[static_cast<std::size_t>(columns / 2)];
}

bool Simulator::next(LidarScan& scan, ScanTruth& truth) {
  if (next_scan_ >= first_silent_scan_) next_scan_ = std::max(next_scan_, restart_scan_);
  if (next_scan_ >= scan_count_) return false;
  const int columns = info_.columns_per_frame;
  const int rows = info_.pixels_per_column;
  if (scan.range_mm.cols != columns || scan.range_mm.rows != rows) {
    scan = LidarScan(PacketFormat(info_));
  }
  set_header(scan, truth);

  const int normals = columns / kNormalStep * (rows / kNormalStep);
  Casting casting{scan,
                  {static_cast<std::size_t>(normals), Eigen::Vector3d::Zero()},
                  Image<std::uint8_t>(rows, columns)};
  options_.parallel_for(columns / kBlockColumns, [&](int block) {
    for (int m = block * kBlockColumns; m < (block + 1) * kBlockColumns; m += kPacketRays) {
      cast_columns(m, casting);
    }
  });

  truth.scan = next_scan_;
  truth.frame_id = static_cast<std::uint16_t>(scan.frame_id);
  truth.start = scan.column_time.front();
  truth.T_world_sensor = true_pose(truth.start);
  set_moving(scan, casting.moving, truth);
  truth.blind_axes = blind_axes(casting.normals);
  for (Eigen::Vector3d& axis : truth.blind_axes) {
    axis = truth.T_world_sensor.rotation.conjugate() * axis;
  }
  ++next_scan_;
  return true;
}

Simulator::Column Simulator::column_at(int m, const LidarScan& scan) const {
  const double t_s = timing_.true_s(scan.column_time[static_cast<std::size_t>(m)]);
  const Pose T_world_sensor = motion_(t_s);
  return {m, T_world_sensor.rotation.toRotationMatrix(), T_world_sensor.translation_m,
          world_.scene.at(t_s)};
}

// Neighbouring columns together: the rays of one row go side by side.
void Simulator::cast_columns(int first, Casting& casting) const {
  const std::array<Column, kPacketRays> columns = {
      column_at(first, casting.scan), column_at(first + 1, casting.scan),
      column_at(first + 2, casting.scan), column_at(first + 3, casting.scan)};
  std::array<const Scene::Moment*, kPacketRays> moments;
  for (std::size_t i = 0; i < columns.size(); ++i) moments[i] = &columns[i].moment;
  for (int row = 0; row < info_.pixels_per_column; ++row) {
    Rays rays;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      // Ranges count from where the ray meets the offset, so that a decoded point is offset + range
      // * direction. The table's directions are per millimetre.
      const Column& column = columns[i];
      rays[i] = {column.rotation * lut_.offset(row, column.m) + column.at_m,
                 1000.0 * (column.rotation * lut_.direction(row, column.m))};
    }
    const Sightings sightings = world_.scene.cast(moments, rays, model_.beam_rad());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      set_pixel(columns[i], rays[i], sightings[i], row, casting);
    }
  }
}

Measurement Simulator::measure(const Column& column, const Ray& ray, const Sighting& sighting,
                               int row, std::uint64_t pixel_key) const {
  if (!sighting.at_edge()) {
    const BeamPart whole{1.0, ray.direction, sighting};
    return model_.measure({&whole, 1}, row, pixel_key);
  }
  // The beam falls on more than one thing.
  std::array<BeamPart, SensorModel::kParts> parts;
  static_assert(SensorModel::kParts == kPacketRays + 1);
  model_.split(ray.direction, parts);
  parts[0].sighting = sighting;
  std::array<const Scene::Moment*, kPacketRays> moments;
  moments.fill(&column.moment);
  Rays rays;
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {ray.origin_m, parts[i + 1].direction};
  const Sightings sightings = world_.scene.cast(moments, rays, 0.0);
  for (std::size_t i = 0; i < rays.size(); ++i) parts[i + 1].sighting = sightings[i];
  return model_.measure(parts, row, pixel_key);
}

void Simulator::set_pixel(const Column& column, const Ray& ray, const Sighting& sighting, int row,
                          Casting& casting) const {
  const int m = column.m;
  LidarScan& scan = casting.scan;
  const std::uint64_t number = scan.sequence * static_cast<std::uint64_t>(info_.columns_per_frame) +
                               static_cast<std::uint64_t>(m);
  const Measurement measured =
      measure(column, ray, sighting, row, number << 8U | static_cast<std::uint64_t>(row));
  const auto& [first, second] = measured.returns;
  scan.range_mm(row, m) = first.range_mm;
  scan.reflectivity(row, m) = first.reflectivity;
  if (!scan.near_ir.empty()) scan.near_ir(row, m) = measured.near_ir;
  if (!scan.signal.empty()) scan.signal(row, m) = first.signal;
  if (!scan.range2_mm.empty()) {
    scan.range2_mm(row, m) = second.range_mm;
    scan.signal2(row, m) = second.signal;
    scan.reflectivity2(row, m) = second.reflectivity;
  }
  casting.moving(row, m) = first.moving ? 1 : 0;
  if (m % kNormalStep == 0 && row % kNormalStep == 0 && first.range_mm > 0 &&
      sighting.surface != nullptr) {
    const int index = m / kNormalStep * (info_.pixels_per_column / kNormalStep) + row / kNormalStep;
    casting.normals[static_cast<std::size_t>(index)] = sighting.hit.normal;
  }
}

}  // namespace glint::synth
