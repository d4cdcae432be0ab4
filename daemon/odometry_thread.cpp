// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/odometry_thread.hpp"

#include <charconv>
#include <utility>

#include "daemon/sensor_change.hpp"
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

OdometryThread::Stream::Stream(const UseSensorCommand& use, const slam::SlamConfig& config)
    : assembler(*use.info), frontend(*use.info, config, stage_clock()) {
  set_sensor(use);
}

void OdometryThread::Stream::set_sensor(const UseSensorCommand& use) {
  info = use.info;
  this_start = use.this_start;
  const std::string& serial = info->serial_number;
  serial_number = 0;
  std::from_chars(serial.data(), serial.data() + serial.size(), serial_number);
}

bool OdometryThread::Stream::is_of_another_start(const PacketView& packet) const {
  // The serial number shows that the packet is this sensor's and its header where it is looked for.
  return this_start && info->init_id != 0 && packet.init_id() != info->init_id &&
         serial_number != 0 && packet.serial_number() == serial_number;
}

OdometryThread::OdometryThread(const Config& config, bool lossless, Crossings& crossings,
                               Heartbeat& heartbeat, ScanListener on_scan)
    : config_(config.slam),
      lossless_(lossless),
      crossings_(crossings),
      heartbeat_(heartbeat),
      on_scan_(std::move(on_scan)) {
  state_.history = TrajectoryHistory(static_cast<std::size_t>(config.state.trajectory_poses));
  publish();
}

void OdometryThread::run() {
  using PopResult = BoundedQueue<ReceivedPacket>::PopResult;
  ReceivedPacket received;
  PopResult result = PopResult::kTimeout;
  apply_commands();  // A sensor that is known from the start is so before its first packet.
  while (result != PopResult::kClosed) {
    heartbeat_.beat();
    result = crossings_.packets.pop(received, kWait);
    if (result == PopResult::kItem) take_packet(received);
    if (result == PopResult::kClosed) flush();
    take_scans();
    publish_counters();
  }
  publish();
  crossings_.keyframes.close();
  heartbeat_.finish();
}

void OdometryThread::take_packet(const ReceivedPacket& received) {
  if (received.silence) {
    flush();
    return;
  }
  if (!stream_) {
    ++state_.early_packets;
    return;
  }
  last_host_time_ = received.packet.host_time;
  last_arrival_ns_ = received.arrival_ns;
  ScanAssembler& assembler = stream_->assembler;
  if (received.packet.bytes.size() == assembler.format().imu_packet_bytes) {
    ++state_.imu_packets;
    return;
  }
  const auto view = PacketView::parse(assembler.format(), received.packet.bytes);
  if (view) crossings_.packet_init_id.store(view->init_id(), std::memory_order_relaxed);
  if (view && stream_->is_of_another_start(*view)) {
    state_.refused.init_id = view->init_id();
    ++state_.early_packets;
    return;
  }
  const std::int64_t start_ns = steady_now_ns();
  // What became of the packet is in the assembler's counters.
  const PacketVerdict verdict = assembler.push(received.packet.bytes);
  decode_ns_ += steady_now_ns() - start_ns;
  note_refusal(received.packet.bytes, verdict);
}

void OdometryThread::note_refusal(std::span<const std::byte> packet, PacketVerdict verdict) {
  if (verdict == PacketVerdict::kBadSize) state_.refused.bytes = packet.size();
  if (verdict != PacketVerdict::kForeign) return;
  const auto view = PacketView::parse(stream_->assembler.format(), packet);
  if (view) state_.refused.serial_number = view->serial_number();
}

void OdometryThread::take_scans() {
  apply_commands();
  process_scans();
}

void OdometryThread::process_scans() {
  while (const LidarScan* scan = stream_ ? stream_->assembler.next() : nullptr) process(*scan);
}

void OdometryThread::flush() {
  if (stream_) stream_->assembler.flush();
}

void OdometryThread::process(const LidarScan& scan) {
  if (state_.paused) {
    ++state_.paused_scans;
    return;
  }
  slam::Frontend& frontend = stream_->frontend;
  const slam::OdometryEstimate& estimate = frontend.process(scan);
  hand_over_keyframe();

  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const std::int64_t ns = frontend.stage_times().wall_ns[i];
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
  std::optional<slam::Keyframe> keyframe = stream_->frontend.take_keyframe();
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
                          [&](ResetOdometryCommand) {
                            if (stream_) stream_->frontend.reset();
                          },
                          [&](const UseSensorCommand& use) { use_sensor(use); },
                          [&](const slam::MapCorrection& c) { state_.correction = c; }},
               command);
  }
  if (!commands.empty()) publish();
}

void OdometryThread::use_sensor(const UseSensorCommand& use) {
  state_.refused = {};
  if (!stream_) {
    stream_.emplace(use, config_);
    return;
  }
  if (stream_change(*stream_->info, *use.info).empty()) {
    stream_->assembler.set_identity(*use.info);
  } else {
    flush();
    process_scans();
    stream_->assembler.change_sensor(*use.info);
    stream_->frontend.change_sensor(*use.info);
  }
  stream_->set_sensor(use);
}

void OdometryThread::publish_counters() {
  if (steady_now_ns() - published_ns_ > kCounterPeriodNs) publish();
}

std::shared_ptr<const Snapshot> OdometryThread::publish() {
  if (stream_) {
    state_.packets = stream_->assembler.counters();
    state_.packet_health = stream_->assembler.health();
  }
  auto snapshot = std::make_shared<const Snapshot>(state_);
  crossings_.snapshot.store(snapshot);
  published_ns_ = steady_now_ns();
  return snapshot;
}

}  // namespace glint::daemon
