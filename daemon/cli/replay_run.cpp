// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/replay_run.hpp"

#include "daemon/steady_clock.hpp"
#include "driver/core/imu_packet.hpp"
#include "slam/frontend.hpp"

namespace glint::cli {
namespace {

// Scans whose images go into the report: the first, and then each time the number doubles, so that
// whatever its length a replay leaves about ten.
bool is_sample(std::uint64_t scan) { return (scan & (scan - 1)) == 0; }
constexpr std::uint64_t kFirstSample = 8;

class Replay {
 public:
  Replay(const SensorInfo& info, const ReplayOptions& options)
      : options_(options),
        clock_(daemon::stage_clock()),
        imu_format_(info),
        assembler_(info),
        frontend_(info, options.slam, clock_, options.R_base_sensor),
        backend_(options.slam, options.session_file, clock_, options.loops,
                 options.earlier_session) {
    backend_.use_sensor(info);
    frontend_.set_searching(!backend_.correction().placed);
  }

  ReplayResult run(PacketSource& source) {
    const std::int64_t start_ns = clock_.monotonic_ns();
    RawPacket packet;
    while (going_) {
      const SourceStatus status = source.read(packet);
      if (status == SourceStatus::kIdle) continue;
      if (status == SourceStatus::kError) result_.source_error = source.error();
      if (status != SourceStatus::kPacket) break;
      decode(packet);
      process_scans();
    }
    if (going_) {
      assembler_.flush();
      process_scans();
    }
    backend_.finish();
    take_loops();
    // No scan waited for it, but its time was spent.
    result_.stages.add(backend_.stage_times());
    result_.map = backend_.snapshot();
    result_.loops_accepted = backend_.loops_accepted();
    result_.loops_rejected = backend_.loops_rejected();
    result_.correction = backend_.correction();
    result_.packets = assembler_.counters();
    result_.keyframes_not_stored = backend_.keyframes_not_stored();
    result_.store_error = backend_.store_error();
    result_.wall_s = static_cast<double>(clock_.monotonic_ns() - start_ns) * kSecondsPerNs;
    return std::move(result_);
  }

 private:
  void decode(const RawPacket& packet) {
    const slam::StageTimer timer(clock_, decode_times_, slam::Stage::kDecode);
    // Whatever it is, the assembler counts it.
    static_cast<void>(assembler_.push(packet.bytes));
    if (packet.bytes.size() != imu_format_.packet_bytes) return;
    imu_samples_.clear();
    if (!parse_imu_packet(imu_format_, packet.bytes, imu_samples_)) return;
    for (const ImuSample& sample : imu_samples_) frontend_.add_imu(sample);
  }

  void take_loops() {
    const auto& reports = backend_.loop_reports();
    result_.loops.insert(result_.loops.end(), reports.begin(), reports.end());
  }

  void process_scans() {
    while (const LidarScan* scan = going_ ? assembler_.next() : nullptr) process(*scan);
  }

  void process(const LidarScan& scan) {
    result_.estimates.push_back(frontend_.process(scan));
    slam::StageTimes times = frontend_.stage_times();
    constexpr auto kDecode = static_cast<std::size_t>(slam::Stage::kDecode);
    times.wall_ns[kDecode] = decode_times_.wall_ns[kDecode];
    times.cpu_ns[kDecode] = decode_times_.cpu_ns[kDecode];
    decode_times_ = {};
    if (const auto keyframe = frontend_.take_keyframe()) {
      backend_.process(*keyframe);
      frontend_.set_searching(!backend_.correction().placed);
      take_loops();
      for (const slam::Stage stage : {slam::Stage::kPgo, slam::Stage::kBackend}) {
        const auto i = static_cast<std::size_t>(stage);
        times.wall_ns[i] = backend_.stage_times().wall_ns[i];
        times.cpu_ns[i] = backend_.stage_times().cpu_ns[i];
      }
    }
    result_.stages.add(times);
    backend_.keep_session();
    const std::uint64_t scans = result_.estimates.size();
    if (scans >= kFirstSample && is_sample(scans)) {
      result_.sample_images.push_back(frontend_.images());
    }
    const bool wanted = !options_.on_scan || options_.on_scan(scans);
    result_.interrupted = !wanted;
    going_ = wanted && (options_.max_scans == 0 || scans < options_.max_scans);
  }

  const ReplayOptions& options_;
  const Clock clock_;
  const ImuPacketFormat imu_format_;
  std::vector<ImuSample> imu_samples_;
  ScanAssembler assembler_;
  slam::Frontend frontend_;
  slam::Backend backend_;
  slam::StageTimes decode_times_;
  ReplayResult result_;
  bool going_ = true;
};

}  // namespace

ReplayResult run_replay(PacketSource& source, const SensorInfo& info,
                        const ReplayOptions& options) {
  return Replay(info, options).run(source);
}

}  // namespace glint::cli
