// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/odometry_thread.hpp"

#include <charconv>
#include <utility>

#include "daemon/protocol.hpp"
#include "daemon/protocol_pose.hpp"
#include "daemon/sensor_change.hpp"
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

OdometryThread::Stream::Stream(const UseSensorCommand& use, const slam::SlamConfig& config,
                               const Eigen::Quaterniond& R_base_sensor)
    : imu_format(*use.info),
      assembler(*use.info),
      clock_model(use.info->scan_period_ns()),
      frontend(*use.info, config, stage_clock(), R_base_sensor) {
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
                               Heartbeat& heartbeat, EventLog& events, ScanListener on_scan)
    : config_(config.slam),
      lossless_(lossless),
      R_base_sensor_(config.mount.T_base_sensor.rotation),
      crossings_(crossings),
      heartbeat_(heartbeat),
      events_(events),
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
  last_arrival_ns_ = received.arrival_ns;
  ScanAssembler& assembler = stream_->assembler;
  if (received.packet.bytes.size() == assembler.format().imu_packet_bytes) {
    take_imu(received.packet.bytes);
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
  if (view && verdict == PacketVerdict::kLidar) look_at_clock(*view, received.packet.host_time);
}

void OdometryThread::note_refusal(std::span<const std::byte> packet, PacketVerdict verdict) {
  if (verdict == PacketVerdict::kBadSize) state_.refused.bytes = packet.size();
  if (verdict != PacketVerdict::kForeign) return;
  const auto view = PacketView::parse(stream_->assembler.format(), packet);
  if (view) state_.refused.serial_number = view->serial_number();
}

void OdometryThread::take_imu(std::span<const std::byte> bytes) {
  imu_samples_.clear();
  if (!parse_imu_packet(stream_->imu_format, bytes, imu_samples_)) {
    ++state_.imu.bad_packets;
    return;
  }
  ++state_.imu.packets;
  for (const ImuSample& sample : imu_samples_) {
    gravity_.add(sample);
    stream_->frontend.add_imu(sample);
  }
}

void OdometryThread::look_at_clock(const PacketView& packet, HostTime host_time) {
  ClockModel& model = stream_->clock_model;
  const auto time = end_time(packet);
  const auto jump = time ? model.add(*time, host_time) : std::nullopt;
  if (!jump) return;
  Json fields = Json::object();
  put_time(fields, *time);
  fields["t_host_ns"] = host_time.ns;
  fields["jump_ns"] = jump->jump_ns;
  fields["offset_ns"] = jump->offset_ns;
  fields["jumps"] = model.status().jumps;
  events_.post({"clock", 0, std::move(fields)});
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
  const std::int64_t start_ns = steady_now_ns();
  slam::OdometryEstimate estimate = frontend.process(scan);
  choose_load(static_cast<double>(steady_now_ns() - start_ns) * kSecondsPerNs);
  state_.host_time = stream_->clock_model.to_host(estimate.stamp).value_or(HostTime{});
  state_.clock = stream_->clock_model.status();
  estimate.stamp = told_time(estimate.stamp);
  hand_over_keyframe();
  show(scan, estimate.stamp);

  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const std::int64_t ns = frontend.stage_times().wall_ns[i];
    if (ns > 0) state_.stages.stages[i].add(ns);
  }
  state_.stages[slam::Stage::kDecode].add(std::exchange(decode_ns_, 0));
  state_.history.append({estimate.stamp, estimate.T_odom_sensor, estimate.velocity, estimate.state,
                         estimate.segment, estimate.frame_id,
                         static_cast<double>(estimate.sequence), state_.host_time,
                         state_.clock.sigma_ns});
  state_.estimate = estimate;
  state_.arrival_ns = last_arrival_ns_;
  ++state_.scans;
  const auto snapshot = publish();
  if (on_scan_) on_scan_(snapshot);
}

// A replay waits for odometry; a sensor does not.
void OdometryThread::choose_load(double took_s) {
  for (std::size_t i = 1; i <= static_cast<std::size_t>(state_.load_level); ++i) {
    ++state_.shed_scans[i];
  }
  if (config_.load_level != "auto") {
    state_.load_level = slam::load_level_of(config_.load_level);
    return;
  }
  if (lossless_) return;
  const SensorInfo& info = *stream_->info;
  const double packets_per_scan =
      static_cast<double>(info.columns_per_frame) / static_cast<double>(info.columns_per_packet);
  const double waiting_scans = static_cast<double>(crossings_.packets.size()) / packets_per_scan;
  const double period_s = static_cast<double>(info.scan_period_ns()) * kSecondsPerNs;
  state_.load_level = governor_.after_scan(took_s, waiting_scans, period_s);
  stream_->frontend.set_load_level(state_.load_level);
}

SensorTime OdometryThread::told_time(SensorTime stamp) const {
  const auto host_time = stream_->clock_model.to_host(stamp);
  return stream_->info->clock == ClockSource::kHost && host_time ? SensorTime{host_time->ns}
                                                                 : stamp;
}

void OdometryThread::hand_over_keyframe() {
  std::optional<slam::Keyframe> keyframe = stream_->frontend.take_keyframe();
  if (!keyframe) return;
  keyframe->estimate.stamp = told_time(keyframe->estimate.stamp);
  if (lossless_) {
    crossings_.keyframes.push_wait(*keyframe);
  } else {
    crossings_.keyframes.push_drop_oldest(*keyframe);
    state_.dropped_keyframes = crossings_.keyframes.dropped();
  }
}

void OdometryThread::show(const LidarScan& scan, SensorTime stamp) {
  if (!crossings_.scan_tap.wanted(steady_now_ns())) return;
  crossings_.scan_tap.put(std::make_shared<const TappedScan>(
      TappedScan{scan, stream_->frontend.images().brightness, stream_->info, stamp}));
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
                          [&](const slam::MapCorrection& c) { take_correction(c); }},
               command);
  }
  if (commands.empty()) return;
  const std::uint32_t epoch = crossings_.snapshot.load()->correction.epoch;
  publish();
  // Only now does whoever asks for a pose get one of the new epoch.
  if (state_.correction.epoch != epoch) events_.post({"epoch", 0, epoch_json(state_)});
}

void OdometryThread::take_correction(const slam::MapCorrection& correction) {
  state_.correction = correction;
  if (stream_) stream_->frontend.set_searching(!correction.placed);
}

void OdometryThread::use_sensor(const UseSensorCommand& use) {
  state_.refused = {};
  if (!stream_) {
    stream_.emplace(use, config_, R_base_sensor_);
    stream_->frontend.set_searching(!state_.correction.placed);
    return;
  }
  if (stream_change(*stream_->info, *use.info).empty()) {
    stream_->assembler.set_identity(*use.info);
  } else {
    flush();
    process_scans();
    stream_->assembler.change_sensor(*use.info);
    stream_->frontend.change_sensor(*use.info);
    stream_->imu_format = ImuPacketFormat(*use.info);
  }
  stream_->set_sensor(use);
}

void OdometryThread::publish_counters() {
  if (steady_now_ns() - published_ns_ > kCounterPeriodNs) publish();
}

void OdometryThread::tell_stream(const Stream& stream) {
  state_.packets = stream.assembler.counters();
  state_.packet_health = stream.assembler.health();
  state_.clock = stream.clock_model.status();
  // Without times of arrival there is none of this machine's to tell.
  const bool unknown = stream.info->clock == ClockSource::kHost && !state_.clock.known;
  state_.clock_source = unknown ? ClockSource::kInternal : stream.info->clock;
}

std::shared_ptr<const Snapshot> OdometryThread::publish() {
  if (stream_) tell_stream(*stream_);
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
