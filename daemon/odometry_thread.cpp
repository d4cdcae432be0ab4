// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/odometry_thread.hpp"

#include <utility>

#include "driver/core/packet_format.hpp"

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

}  // namespace

OdometryThread::OdometryThread(const SensorInfo& info, const Config& config, bool lossless,
                               Crossings& crossings, Heartbeat& heartbeat, ScanListener on_scan)
    : lossless_(lossless),
      crossings_(crossings),
      heartbeat_(heartbeat),
      on_scan_(std::move(on_scan)),
      assembler_(info),
      frontend_(info, config.slam, stage_clock()) {
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
  last_host_time_ = received.packet.host_time;
  last_arrival_ns_ = received.arrival_ns;
  if (received.packet.bytes.size() == assembler_.format().imu_packet_bytes) {
    ++state_.imu_packets;
    return;
  }
  const std::int64_t start_ns = steady_now_ns();
  // What became of the packet is in the assembler's counters.
  static_cast<void>(assembler_.push(received.packet.bytes));
  decode_ns_ += steady_now_ns() - start_ns;
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
  const slam::OdometryEstimate& estimate = frontend_.process(scan);
  hand_over_keyframe();

  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const std::int64_t ns = frontend_.stage_times().wall_ns[i];
    if (ns > 0) state_.stages.stages[i].add(ns);
  }
  state_.stages[slam::Stage::kDecode].add(std::exchange(decode_ns_, 0));
  state_.history.append({estimate.stamp, estimate.T_odom_sensor, estimate.velocity, estimate.state,
                         estimate.segment, estimate.frame_id});
  state_.estimate = estimate;
  state_.host_time = last_host_time_;
  state_.arrival_ns = last_arrival_ns_;
  ++state_.scans;
  const auto snapshot = publish();
  if (on_scan_) on_scan_(snapshot);
}

void OdometryThread::hand_over_keyframe() {
  std::optional<slam::Keyframe> keyframe = frontend_.take_keyframe();
  if (!keyframe) return;
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
  auto snapshot = std::make_shared<const Snapshot>(state_);
  crossings_.snapshot.store(snapshot);
  published_ns_ = steady_now_ns();
  return snapshot;
}

}  // namespace glint::daemon
