// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/synthetic_source.hpp"

#include <cmath>
#include <utility>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

constexpr std::int64_t kHostStartNs = 1'700'001'000 * kNsPerSecond;
// From the last measurement of a packet until it is in the host's hands; the network adds up to as
// much as the second number.
constexpr double kDelayS = 350e-6;
constexpr double kJitterS = 150e-6;
constexpr double kImuRateHz = 100.0;
// IMU and lidar do not measure at the same moments.
constexpr double kImuPhaseS = 0.0037;

SensorInfo restarted(SensorInfo info) {
  if (info.init_id != 0) ++info.init_id;
  return info;
}

Eigen::Vector3d imu_position_m(const SensorInfo& info) {
  return 0.001 * info.imu_to_sensor.topRightCorner<3, 1>();
}

}  // namespace

SyntheticSource::SyntheticSource(const SimulationOptions& options, Pacer pacer)
    : options_(options),
      simulator_(options),
      imu_(simulator_.motion(), imu_position_m(simulator_.info()), kImuRateHz, options.imu,
           options.seed),
      network_(options.network, options.seed),
      pacer_(std::move(pacer)),
      writers_{PacketWriter(simulator_.info()), PacketWriter(restarted(simulator_.info()))},
      imu_writers_{ImuPacketWriter(simulator_.info()),
                   ImuPacketWriter(restarted(simulator_.info()))} {
  const SensorInfo& info = simulator_.info();
  if (options.stream.first_column < 0 || options.stream.first_column >= info.columns_per_frame) {
    throw OptionError("the first column is none of the scan's");
  }
}

SourceStatus SyntheticSource::read(RawPacket& packet) {
  if (stopped_) return SourceStatus::kEnd;
  if (waiting_.bytes.empty()) {
    const SourceStatus status =
        network_.receive([this](RawPacket& sent) { return send(sent); }, waiting_);
    if (status != SourceStatus::kPacket) return status;
  }
  if (pacer_ && !pacer_(waiting_.host_time)) return SourceStatus::kIdle;
  std::swap(packet, waiting_);
  waiting_.bytes.clear();
  return SourceStatus::kPacket;
}

// The one of the two streams that comes first.
SourceStatus SyntheticSource::send(RawPacket& packet) {
  if (lidar_packet_.bytes.empty() && !next_lidar()) return SourceStatus::kEnd;
  if (imu_packet_.bytes.empty()) next_imu();
  RawPacket& first = imu_packet_.host_time < lidar_packet_.host_time ? imu_packet_ : lidar_packet_;
  std::swap(packet, first);
  first.bytes.clear();
  return SourceStatus::kPacket;
}

bool SyntheticSource::next_lidar() {
  const SensorInfo& info = simulator_.info();
  while (true) {
    if (next_packet_ < 0) {
      const bool first_scan = truth_.scan < 0;
      if (!simulator_.next(scan_, truth_)) return false;
      next_packet_ = first_scan ? options_.stream.first_column / info.columns_per_packet : 0;
    }
    const int index = next_packet_;
    const PacketWriter& writer = writers_[truth_.restarted ? 1 : 0];
    if (++next_packet_ == writer.packets_per_scan()) next_packet_ = -1;
    const std::int64_t last_column = std::int64_t{truth_.scan} * info.columns_per_frame +
                                     std::int64_t{index + 1} * info.columns_per_packet - 1;
    const double measured_s = simulator_.timing().column_s(last_column);
    if (silent(measured_s)) continue;
    writer.write(scan_, index, lidar_packet_.bytes);
    lidar_packet_.host_time = arrival(measured_s, 0);
    lidar_packet_.port = static_cast<std::uint16_t>(info.lidar_port);
    return true;
  }
}

void SyntheticSource::next_imu() {
  const SensorInfo& info = simulator_.info();
  const Timing& timing = simulator_.timing();
  while (true) {
    imu_samples_.clear();
    double sample_s = 0.0;
    for (int i = 0; i < imu_writers_[0].format().measurements; ++i, ++next_sample_) {
      sample_s = kImuPhaseS + static_cast<double>(next_sample_) / kImuRateHz;
      const ImuModel::Reading reading = imu_.measure(sample_s);
      const SensorTime time = timing.clock_at(sample_s);
      imu_samples_.push_back({time, time, reading.acceleration_mps2, reading.angular_rate_radps});
    }
    if (silent(sample_s)) continue;
    imu_writers_[truth_.restarted ? 1 : 0].write(imu_samples_, truth_.frame_id, 0,
                                                 imu_packet_.bytes);
    imu_packet_.host_time = arrival(sample_s, 1);
    imu_packet_.port = static_cast<std::uint16_t>(info.imu_port);
    return;
  }
}

bool SyntheticSource::silent(double true_s) const {
  const StreamOptions& stream = options_.stream;
  return stream.restart_at_s > 0.0 && true_s >= stream.restart_at_s &&
         true_s < stream.restart_at_s + stream.restart_gap_s;
}

HostTime SyntheticSource::arrival(double true_s, std::uint64_t kind) const {
  const auto true_ns = std::llround(1e9 * true_s);
  Random network{options_.seed, 0x9E7ULL, kind, static_cast<std::uint64_t>(true_ns)};
  return {kHostStartNs + true_ns + std::llround(1e9 * (kDelayS + kJitterS * network.uniform()))};
}

}  // namespace glint::synth
