// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/backend_thread.hpp"

namespace glint::daemon {
namespace {

constexpr std::chrono::milliseconds kWait{100};

}  // namespace

BackendThread::BackendThread(const Config& config, const std::filesystem::path& session_file,
                             Crossings& crossings, Heartbeat& heartbeat)
    : crossings_(crossings),
      heartbeat_(heartbeat),
      backend_(config.slam, session_file, stage_clock()) {
  publish();
}

void BackendThread::run() {
  using PopResult = BoundedQueue<slam::Keyframe>::PopResult;
  slam::Keyframe keyframe;
  PopResult result = PopResult::kTimeout;
  while (result != PopResult::kClosed) {
    heartbeat_.beat();
    result = crossings_.keyframes.pop(keyframe, kWait);
    look_at_sensor();
    if (result == PopResult::kItem) process(keyframe);
  }
  heartbeat_.finish();
}

void BackendThread::look_at_sensor() {
  std::shared_ptr<const SensorInfo> sensor = crossings_.sensor.load();
  if (sensor == sensor_) return;
  sensor_ = std::move(sensor);
  backend_.use_sensor(*sensor_);
}

void BackendThread::process(const slam::Keyframe& keyframe) {
  const std::uint32_t epoch = backend_.correction().epoch;
  backend_.process(keyframe);
  duration_.add(backend_.last_wall_ns());
  publish();
  if (backend_.correction().epoch != epoch) crossings_.commands.post(backend_.correction());
}

void BackendThread::publish() {
  auto state = std::make_shared<MapState>();
  state->map = backend_.snapshot();
  if (state->map == nullptr) state->map = std::make_shared<const slam::MapSnapshot>();
  state->backend = duration_;
  state->store_failures = backend_.store_failures();
  state->store_error = backend_.store_error();
  crossings_.map.store(std::move(state));
}

}  // namespace glint::daemon
