// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/runtime.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <utility>

#include "daemon/clock_settings.hpp"

namespace glint::daemon {
namespace {

/// A live queue bridges two seconds, a machine's worst hiccup; in replay it only smooths.
constexpr int kLiveScans = 20;
constexpr int kReplayScans = 4;
/// Of a live queue while the sensor is not known: enough for any mode with 16 columns a packet.
constexpr std::size_t kUnknownSensorPackets = 2560;
constexpr double kUsualScanRateHz = 10.0;
constexpr std::chrono::milliseconds kWorkerWait{500};
constexpr const char* kStoreWithoutError = "the back end has ended";

std::size_t packet_capacity(const std::optional<SensorInfo>& info, bool lossless) {
  if (!info) return kUnknownSensorPackets;
  const int packets_per_scan = info->columns_per_frame / std::max(1, info->columns_per_packet);
  return static_cast<std::size_t>(std::max(1, packets_per_scan) *
                                  (lossless ? kReplayScans : kLiveScans));
}

template <class T>
QueueStatus queue_status(const BoundedQueue<T>& queue) {
  return {queue.size(), queue.capacity(), queue.dropped()};
}

void run_job(RunningJob& job, const JobBody& body) {
  try {
    if (auto result = body(job)) {
      job.done(std::move(*result));
    } else {
      job.cancel();
    }
  } catch (const std::exception& error) {
    job.fail(error.what());
  }
}

}  // namespace

Runtime::Runtime(const std::optional<SensorInfo>& info, const Config& config,
                 std::unique_ptr<PacketSource> source, RuntimeOptions options)
    : config_(config),
      options_(std::move(options)),
      source_(std::move(source)),
      jobs_(*options_.events),
      crossings_(packet_capacity(info, options_.lossless)),
      backend_(config_, options_.session, options_.loops, crossings_, backend_heartbeat_,
               *options_.events) {
  if (info) use_sensor(*info);
}

Runtime::~Runtime() { stop(); }

void Runtime::start(ScanListener on_scan) {
  receive_ =
      std::make_unique<ReceiveThread>(*source_, options_.lossless, crossings_, receive_heartbeat_);
  odometry_ =
      std::make_unique<OdometryThread>(config_, options_.lossless, crossings_, odometry_heartbeat_,
                                       *options_.events, std::move(on_scan));
  spawn("odometry", [this] { odometry_->run(); });
  spawn("backend", [this] { backend_.run(); });
  spawn("worker", [this] { work(crossings_.jobs, &worker_heartbeat_); });
  spawn("jobs", [this] { work(crossings_.long_jobs, nullptr); });
  spawn("receive", [this] { receive_->run(); });
}

void Runtime::stop() {
  jobs_.close();
  source_->stop();
  crossings_.jobs.close();
  crossings_.long_jobs.close();
  // Each stage closes the queue to the next one when it has finished.
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void Runtime::spawn(const char* name, std::function<void()> body) {
  threads_.emplace_back([this, name, body = std::move(body)] {
    pthread_setname_np(pthread_self(), name);
    try {
      body();
    } catch (const std::exception& error) {
      {
        const std::lock_guard lock(fault_mutex_);
        if (fault_.empty()) fault_ = fmt::format("thread {}: {}", name, error.what());
      }
      // Nobody may wait for a thread that is gone.
      source_->stop();
      crossings_.close();
    }
  });
}

void Runtime::work(BoundedQueue<Job>& queue, Heartbeat* heartbeat) {
  using PopResult = BoundedQueue<Job>::PopResult;
  Job job;
  PopResult result = PopResult::kTimeout;
  while (result != PopResult::kClosed) {
    if (heartbeat != nullptr) heartbeat->beat();
    result = queue.pop(job, kWorkerWait);
    if (result == PopResult::kItem) std::exchange(job, nullptr)();
  }
  if (heartbeat != nullptr) heartbeat->finish();
}

std::optional<JobReport> Runtime::start_job(const std::string& kind, JobBody body) {
  const std::shared_ptr<RunningJob> job = jobs_.begin(kind);
  if (!job) return std::nullopt;
  JobReport begun = job->report();
  Job work = [job, body = std::move(body)] { run_job(*job, body); };
  // Only a runtime that stops has no room for it: the board has one job at a time.
  if (!crossings_.long_jobs.try_push(work)) return std::nullopt;
  return begun;
}

bool Runtime::commit_session(RunningJob& job) {
  const auto outcome = crossings_.session_commit.wait([&] { return job.progress(0.0); });
  if (outcome == CommitRequest::Outcome::kFailed) {
    const std::string& why = crossings_.map.load()->store_error;
    throw InputError(fmt::format("the session cannot be brought onto the disk: {}",
                                 why.empty() ? kStoreWithoutError : why));
  }
  return outcome == CommitRequest::Outcome::kDone;
}

void Runtime::use_sensor(const SensorInfo& info, bool this_start) {
  const auto shared = std::make_shared<const SensorInfo>(with_clock_settings(info, config_.sensor));
  crossings_.expected.lidar_bytes = PacketFormat(info).packet_bytes;
  crossings_.expected.silence_ns =
      std::max(3 * info.scan_period_ns(), ExpectedPackets::kLeastSilenceNs);
  crossings_.sensor.store(shared);
  post(UseSensorCommand{shared, this_start});
}

double Runtime::scan_rate_hz() const {
  const auto info = sensor();
  return info ? info->scan_rate_hz : kUsualScanRateHz;
}

std::int64_t Runtime::scan_period_ns() const {
  return static_cast<std::int64_t>(1e9 / scan_rate_hz());
}

LastPacket Runtime::last_packet() const {
  return {crossings_.source.last_packet_ns.load(), crossings_.packet_init_id.load()};
}

RuntimeStatus Runtime::status() const {
  RuntimeStatus status;
  status.snapshot = crossings_.snapshot.load();
  status.map = crossings_.map.load();
  status.source = crossings_.source.state.load();
  if (status.source == SourceState::kFailed) status.source_error = crossings_.source.error;
  if (status.source == SourceState::kFailed || status.source == SourceState::kEnded) {
    status.source_notices = crossings_.source.notices;
  }
  status.sensor = sensor();
  status.packets_received = crossings_.source.packets.load();
  status.kernel_drops = crossings_.source.kernel_drops.load();
  status.foreign = crossings_.source.foreign.load();
  status.packets = queue_status(crossings_.packets);
  status.keyframes = queue_status(crossings_.keyframes);
  status.jobs = jobs_.latest();
  return status;
}

bool Runtime::alive(std::int64_t limit_ns) const {
  const std::int64_t now_ns = steady_now_ns();
  return receive_heartbeat_.fresh(now_ns, limit_ns) &&
         odometry_heartbeat_.fresh(now_ns, limit_ns) &&
         backend_heartbeat_.fresh(now_ns, limit_ns) && worker_heartbeat_.fresh(now_ns, limit_ns);
}

std::string Runtime::fault() const {
  const std::lock_guard lock(fault_mutex_);
  return fault_;
}

}  // namespace glint::daemon
