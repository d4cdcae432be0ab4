// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/odometry_thread.hpp"

#include <utility>

#include "daemon/protocol.hpp"
#include "driver/core/packet_view.hpp"

namespace glint::daemon {
namespace {

constexpr std::chrono::milliseconds kWait{100};
/// Counters are published this often when no scan does it.
constexpr std::int64_t kCounterPeriodNs = 200'000'000;

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

/// When a packet was finished, which is when its last column was measured: it cannot have been
/// sent before. Null if it has no valid column.
std::optional<SensorTime> end_time(const PacketView& packet) {
  for (int i = packet.column_count() - 1; i >= 0; --i) {
    if (packet.column(i).valid()) return packet.column(i).time();
  }
  return std::nullopt;
}

}  // namespace

OdometryThread::OdometryThread(const SensorInfo& info, const Config& config, bool lossless,
                               Crossings& crossings, Heartbeat& heartbeat, EventLog& events,
                               ScanListener on_scan)
    : lossless_(lossless),
      clock_source_(info.clock),
      R_base_sensor_(config.mount.T_base_sensor.rotation),
      imu_format_(info),
      crossings_(crossings),
      heartbeat_(heartbeat),
      events_(events),
      on_scan_(std::move(on_scan)),
      assembler_(info),
      clock_model_(info.scan_period_ns()),
      frontend_(info, config.slam, stage_clock(), R_base_sensor_) {
  state_.history = TrajectoryHistory(static_cast<std::size_t>(config.state.trajectory_poses));
  publish();
}

void OdometryThread::run() {
  using PopResult = BoundedQueue<ReceivedPacket>::PopResult;
  ReceivedPacket received;
  PopResult result = PopResult::kTimeout;
  while (result != PopResult::kClosed) {
    heartbeat_.beat();
    result = crossings_.packets.pop(received, kWait);
    if (result == PopResult::kItem) take_packet(received);
    if (result == PopResult::kClosed) assembler_.flush();
    take_scans();
    publish_counters();
  }
  publish();
  crossings_.keyframes.close();
  heartbeat_.finish();
}

void OdometryThread::take_packet(const ReceivedPacket& received) {
  if (received.silence) {
    assembler_.flush();
    return;
  }
  last_arrival_ns_ = received.arrival_ns;
  if (received.packet.bytes.size() == assembler_.format().imu_packet_bytes) {
    take_imu(received.packet.bytes);
    return;
  }
  const std::int64_t start_ns = steady_now_ns();
  // What became of the packet is in the assembler's counters.
  const PacketError error = assembler_.push(received.packet.bytes);
  decode_ns_ += steady_now_ns() - start_ns;
  if (error == PacketError::kNone) look_at_clock(received.packet);
}

void OdometryThread::take_imu(std::span<const std::byte> bytes) {
  imu_samples_.clear();
  if (!parse_imu_packet(imu_format_, bytes, imu_samples_)) {
    ++state_.imu.bad_packets;
    return;
  }
  ++state_.imu.packets;
  for (const ImuSample& sample : imu_samples_) gravity_.add(sample);
}

void OdometryThread::look_at_clock(const RawPacket& packet) {
  const auto view = PacketView::parse(assembler_.format(), packet.bytes);
  const auto time = view ? end_time(*view) : std::nullopt;
  const auto jump = time ? clock_model_.add(*time, packet.host_time) : std::nullopt;
  if (!jump) return;
  Json fields = Json::object();
  put_time(fields, *time);
  fields["t_host_ns"] = packet.host_time.ns;
  fields["jump_ns"] = jump->jump_ns;
  fields["offset_ns"] = jump->offset_ns;
  fields["jumps"] = clock_model_.status().jumps;
  events_.post({"clock", 0, std::move(fields)});
}

void OdometryThread::take_scans() {
  apply_commands();
  while (const LidarScan* scan = assembler_.next()) process(*scan);
}

void OdometryThread::process(const LidarScan& scan) {
  if (state_.paused) {
    ++state_.paused_scans;
    return;
  }
  slam::OdometryEstimate estimate = frontend_.process(scan);
  state_.host_time = clock_model_.to_host(estimate.stamp).value_or(HostTime{});
  state_.clock = clock_model_.status();
  estimate.stamp = told_time(estimate.stamp);
  hand_over_keyframe();

  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const std::int64_t ns = frontend_.stage_times().wall_ns[i];
    if (ns > 0) state_.stages.stages[i].add(ns);
  }
  state_.stages[slam::Stage::kDecode].add(std::exchange(decode_ns_, 0));
  state_.history.append({estimate.stamp, estimate.T_odom_sensor, estimate.velocity, estimate.state,
                         estimate.segment, estimate.frame_id, state_.host_time,
                         state_.clock.sigma_ns});
  state_.estimate = estimate;
  state_.arrival_ns = last_arrival_ns_;
  ++state_.scans;
  const auto snapshot = publish();
  if (on_scan_) on_scan_(snapshot);
}

SensorTime OdometryThread::told_time(SensorTime stamp) const {
  const auto host_time = clock_model_.to_host(stamp);
  return clock_source_ == ClockSource::kHost && host_time ? SensorTime{host_time->ns} : stamp;
}

void OdometryThread::hand_over_keyframe() {
  std::optional<slam::Keyframe> keyframe = frontend_.take_keyframe();
  if (!keyframe) return;
  keyframe->estimate.stamp = told_time(keyframe->estimate.stamp);
  if (lossless_) {
    crossings_.keyframes.push_wait(*keyframe);
  } else {
    crossings_.keyframes.push_drop_oldest(*keyframe);
    state_.dropped_keyframes = crossings_.keyframes.dropped();
  }
}

void OdometryThread::apply_commands() {
  const std::vector<Command> commands = crossings_.commands.take();
  for (const Command& command : commands) {
    std::visit(Overloaded{[&](PauseCommand) { state_.paused = true; },
                          [&](ResumeCommand) { state_.paused = false; },
                          [&](ResetOdometryCommand) { frontend_.reset(); },
                          [&](const slam::MapCorrection& c) { state_.correction = c; }},
               command);
  }
  if (!commands.empty()) publish();
}

void OdometryThread::publish_counters() {
  if (steady_now_ns() - published_ns_ > kCounterPeriodNs) publish();
}

std::shared_ptr<const Snapshot> OdometryThread::publish() {
  state_.packets = assembler_.counters();
  // Without times of arrival there is none of this machine's to tell.
  const bool unknown = clock_source_ == ClockSource::kHost && !clock_model_.status().known;
  state_.clock_source = unknown ? ClockSource::kInternal : clock_source_;
  state_.clock = clock_model_.status();
  state_.imu.rate_hz = gravity_.rate_hz();
  state_.imu.up_mps2 = gravity_.up_mps2();
  if (state_.imu.up_mps2) {
    state_.imu.mount_tilt_deg = mount_tilt_deg(*state_.imu.up_mps2, R_base_sensor_);
  }
  auto snapshot = std::make_shared<const Snapshot>(state_);
  crossings_.snapshot.store(snapshot);
  published_ns_ = steady_now_ns();
  return snapshot;
}

}  // namespace glint::daemon
