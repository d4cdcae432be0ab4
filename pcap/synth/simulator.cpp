// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/simulator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "driver/core/packet_writer.hpp"

namespace glint::synth {
namespace {

constexpr std::int64_t kSensorStart_ns = 1'000 * kNsPerSecond;
constexpr std::int64_t kHostMinusSensor_ns = 1'700'000'000 * kNsPerSecond;
constexpr std::int64_t kPacketDelay_ns = 150'000;
constexpr std::uint16_t kFirstFrameId = 1;
// The motor's speed swings by this share over this many revolutions.
constexpr double kMotorSwing = 0.002;
constexpr double kMotorRevolutions = 5.3;
// An axis with less than this share of the returns' normals along it is not seen.
constexpr double kBlindShare = 0.01;

int scans_in(const SimulationOptions& options) {
  if (!(options.seconds > 0.0 && options.seconds <= 1e6)) {
    throw OptionError("--seconds must be above 0 and at most 1000000");
  }
  return std::max(1, static_cast<int>(std::lround(options.seconds * options.sensor.rate_hz)));
}

SensorOptions with_seed(SensorOptions sensor, std::uint64_t seed) {
  sensor.seed = seed;
  return sensor;
}

std::vector<Eigen::Vector3d> blind_axes(const Eigen::Matrix3d& information,
                                        const Pose& T_world_sensor) {
  std::vector<Eigen::Vector3d> axes;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  for (int i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()(i) < kBlindShare * information.trace()) {
      axes.emplace_back(T_world_sensor.rotation.conjugate() * eigen.eigenvectors().col(i));
    }
  }
  return axes;
}

}  // namespace

Simulator::Simulator(const SimulationOptions& options)
    : options_(options),
      info_(make_sensor(with_seed(options.sensor, options.seed))),
      world_(make_world(options.world, options.seed)),
      lut_(info_),
      model_(info_, options.seed),
      scan_count_(scans_in(options)) {}

Pose Simulator::true_pose(SensorTime time) const {
  return world_.motion.at(static_cast<double>(time.ns - kSensorStart_ns) * kSecondsPerNs);
}

SensorTime Simulator::column_time(std::int64_t column) const {
  const double period_ns = static_cast<double>(info_.scan_period_ns());
  const double revolutions = static_cast<double>(column) / info_.columns_per_frame;
  const double angle = 2.0 * M_PI / kMotorRevolutions;
  const double swing = kMotorSwing / angle * std::sin(angle * revolutions);
  return {kSensorStart_ns + std::llround(period_ns * (revolutions + swing))};
}

bool Simulator::next(LidarScan& scan, ScanTruth& truth) {
  if (next_scan_ >= scan_count_) return false;
  const int columns = info_.columns_per_frame;
  if (scan.range_mm.cols != columns) scan = LidarScan(PacketFormat(info_));
  scan.sequence = static_cast<std::uint64_t>(next_scan_);
  scan.frame_id = static_cast<std::uint16_t>(kFirstFrameId + next_scan_);
  for (int m = 0; m < columns; ++m) {
    const auto column = static_cast<std::size_t>(m);
    scan.column_time[column] = column_time(std::int64_t{next_scan_} * columns + m);
    scan.column_status[column] = info_.profile == LidarProfile::kLegacy ? 0xFFFFFFFFU : 1U;
  }

  const int threads = std::clamp(options_.threads, 1, 64);
  std::vector<Eigen::Matrix3d> information(static_cast<std::size_t>(threads),
                                           Eigen::Matrix3d::Zero());
  {
    std::vector<std::jthread> workers;
    for (int i = 0; i < threads; ++i) {
      workers.emplace_back([&, i] {
        cast_columns(columns * i / threads, columns * (i + 1) / threads, scan,
                     information[static_cast<std::size_t>(i)]);
      });
    }
  }
  truth.frame_id = scan.frame_id;
  truth.start = scan.column_time.front();
  truth.T_world_sensor = true_pose(truth.start);
  truth.moving_share = 0.0;
  Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& part : information) total += part;
  truth.blind_axes = blind_axes(total, truth.T_world_sensor);
  ++next_scan_;
  return true;
}

void Simulator::cast_columns(int first, int last, LidarScan& scan,
                             Eigen::Matrix3d& information) const {
  const bool dual = !scan.range2_mm.empty();
  for (int m = first; m < last; ++m) {
    const Pose T_world_sensor = true_pose(scan.column_time[static_cast<std::size_t>(m)]);
    for (int row = 0; row < info_.pixels_per_column; ++row) {
      const Eigen::Vector3d origin = T_world_sensor * lut_.offset(row, m);
      const Eigen::Vector3d direction =
          (T_world_sensor.rotation * lut_.direction(row, m)).normalized();
      const auto hit = world_.scene.cast(origin, direction);
      const std::uint64_t pixel =
          (scan.sequence * static_cast<std::uint64_t>(info_.columns_per_frame) +
           static_cast<std::uint64_t>(m)) *
              256 +
          static_cast<std::uint64_t>(row);
      const Measurement measured = model_.measure(hit, direction, row, pixel);
      scan.range_mm(row, m) = measured.range_mm;
      if (!scan.signal.empty()) scan.signal(row, m) = measured.signal;
      scan.reflectivity(row, m) = measured.reflectivity;
      scan.near_ir(row, m) = measured.near_ir;
      if (measured.range_mm > 0) information += hit->normal * hit->normal.transpose();
      if (dual) {
        // Opaque surfaces: no second return.
        scan.range2_mm(row, m) = 0;
        scan.signal2(row, m) = 0;
        scan.reflectivity2(row, m) = 0;
      }
    }
  }
}

struct SyntheticSource::Impl {
  explicit Impl(const SimulationOptions& options) : simulator(options), writer(simulator.info()) {}
  Simulator simulator;
  PacketWriter writer;
  LidarScan scan;
  std::vector<ScanTruth> truth;
  int next_packet = -1;  // Of `scan`; -1 when the next scan is to be cast.
  std::atomic<bool> stopped = false;
};

SyntheticSource::SyntheticSource(const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}

SyntheticSource::~SyntheticSource() = default;

SourceStatus SyntheticSource::read(RawPacket& packet) {
  Impl& my = *impl_;
  if (my.stopped) return SourceStatus::kEnd;
  if (my.next_packet < 0) {
    ScanTruth truth;
    if (!my.simulator.next(my.scan, truth)) return SourceStatus::kEnd;
    my.truth.push_back(std::move(truth));
    my.next_packet = 0;
  }
  my.writer.write(my.scan, my.next_packet, packet.bytes);
  const SensorInfo& info = my.simulator.info();
  const auto last_column =
      static_cast<std::size_t>((my.next_packet + 1) * info.columns_per_packet - 1);
  packet.host_time = {my.scan.column_time[last_column].ns + kHostMinusSensor_ns + kPacketDelay_ns};
  packet.port = static_cast<std::uint16_t>(info.lidar_port);
  if (++my.next_packet == my.writer.packets_per_scan()) my.next_packet = -1;
  return SourceStatus::kPacket;
}

void SyntheticSource::stop() { impl_->stopped = true; }

const Simulator& SyntheticSource::simulator() const { return impl_->simulator; }

const std::vector<ScanTruth>& SyntheticSource::truth() const { return impl_->truth; }

}  // namespace glint::synth
