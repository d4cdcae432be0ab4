// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/backend_thread.hpp"

#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "daemon/protocol_pose.hpp"
#include "driver/core/error.hpp"

namespace glint::daemon {
namespace {

slam::SlamConfig slam_config(const Config& config) {
  slam::SlamConfig slam = config.slam;
  slam.map_memory_mb = config.map.memory_mb;
  return slam;
}

constexpr std::chrono::milliseconds kKeyframeWait{100};

// What has happened to the map.
const char* action_between(const slam::MapCorrection& before, const slam::MapCorrection& now) {
  if (!now.placed) return "loaded";
  return before.placed ? "corrected" : "located";
}

}  // namespace

BackendThread::BackendThread(const Config& config, SessionPlan plan,
                             std::function<slam::LoopSource()> make_loops, Crossings& crossings,
                             Heartbeat& heartbeat, EventLog& events)
    : config_(slam_config(config)),
      make_loops_(std::move(make_loops)),
      plan_(std::move(plan)),
      crossings_(crossings),
      heartbeat_(heartbeat),
      events_(events),
      backend_(make_backend()) {
  tell({});
}

std::unique_ptr<slam::Backend> BackendThread::make_backend() const {
  slam::LoopSource loops = make_loops_ ? make_loops_() : slam::LoopSource{};
  // A large map takes long to read: each of its keyframes is a sign of life.
  if (loops.remember) {
    loops.remember = [this, remember = std::move(loops.remember)](const slam::Keyframe& keyframe) {
      heartbeat_.beat();
      remember(keyframe);
    };
  }
  return std::make_unique<slam::Backend>(config_, plan_.file, stage_clock(), std::move(loops),
                                         plan_.earlier);
}

void BackendThread::run() {
  using PopResult = BoundedQueue<slam::Keyframe>::PopResult;
  slam::Keyframe keyframe;
  PopResult result = PopResult::kTimeout;
  while (result != PopResult::kClosed) {
    heartbeat_.beat();
    result = crossings_.keyframes.pop(keyframe, kKeyframeWait);
    look_at_sensor();
    if (result == PopResult::kItem) process(keyframe);
    keep_session();
    crossings_.session_commit.serve([this] { return commit_session(); });
    if (const auto change = crossings_.map_change.take()) change_map(*change);
  }
  const slam::MapCorrection before = backend_->correction();
  backend_->finish();
  crossings_.session_commit.close(commit_session());
  crossings_.map_change.close();
  tell(before);
  correct_last_snapshot();
  heartbeat_.finish();
}

void BackendThread::look_at_sensor() {
  std::shared_ptr<const SensorInfo> sensor = crossings_.sensor.load();
  if (sensor == sensor_) return;
  sensor_ = std::move(sensor);
  backend_->use_sensor(*sensor_);
}

void BackendThread::process(const slam::Keyframe& keyframe) {
  const slam::MapCorrection before = backend_->correction();
  backend_->process(keyframe);
  const auto wall_ns = [&](slam::Stage stage) {
    return backend_->stage_times().wall_ns[static_cast<std::size_t>(stage)];
  };
  duration_.add(wall_ns(slam::Stage::kBackend));
  pgo_duration_.add(wall_ns(slam::Stage::kPgo));
  tell(before);
  if (backend_->searching_s() > plan_.search_s) begin_another_map();
}

// The map there is now stays until the other one is there.
void BackendThread::change_map(const MapChange& change) {
  const slam::MapCorrection before = backend_->correction();
  const SessionPlan plan_before = std::exchange(plan_, change.plan);
  try {
    std::unique_ptr<slam::Backend> other = make_backend();
    backend_->finish();
    backend_ = std::move(other);
  } catch (const std::exception& error) {
    plan_ = plan_before;
    return change.job->fail(error.what());
  }
  backend_->begin_at_epoch(before.epoch + 1);
  if (sensor_) backend_->use_sensor(*sensor_);
  tell(before, change.plan.earlier.empty() ? "cleared" : "loaded");
  change.job->done(Json{{"keyframes", backend_->snapshot()->keyframe_count},
                        {"map_epoch", backend_->correction().epoch}});
}

// The sensor is nowhere in the map that it was to go on with.
void BackendThread::begin_another_map() {
  const slam::MapCorrection before = backend_->correction();
  const std::vector<slam::Keyframe> waiting = backend_->give_up_search();
  plan_.earlier.clear();
  plan_.file = plan_.otherwise;
  try {
    backend_ = make_backend();
  } catch (const InputError& error) {
    spdlog::error("no session is kept: {}", error.what());
    plan_.file.clear();
    backend_ = make_backend();
  }
  backend_->begin_at_epoch(before.epoch + 1);
  if (sensor_) backend_->use_sensor(*sensor_);
  spdlog::warn("the sensor was not found in the map for {:.0f} s: a map of its own is begun",
               plan_.search_s);
  for (const slam::Keyframe& keyframe : waiting) {
    backend_->process(keyframe);
    heartbeat_.beat();
  }
  tell(before, "begun");
}

// Keyframes may be long in coming, but what the disk does not take is told at once.
void BackendThread::keep_session() {
  const std::uint64_t failures = backend_->store_failures();
  backend_->keep_session();
  if (backend_->store_failures() != failures) publish();
}

// Whoever asked for it looks for the reason in what is published.
bool BackendThread::commit_session() {
  const bool done = backend_->commit_session();
  if (!done) publish();
  return done;
}

// Odometry has ended, and what it was told last it may not have seen.
void BackendThread::correct_last_snapshot() {
  const std::shared_ptr<const Snapshot> last = crossings_.snapshot.load();
  if (last->correction.epoch == backend_->correction().epoch) return;
  auto corrected = std::make_shared<Snapshot>(*last);
  corrected->correction = backend_->correction();
  crossings_.snapshot.store(corrected);
  events_.post({"epoch", 0, epoch_json(*corrected)});
}

// `action`: what has happened to the map, where it does not follow from the two corrections.
void BackendThread::tell(const slam::MapCorrection& before, const char* action) {
  publish();
  for (const slam::LoopReport& report : backend_->loop_reports()) {
    Json fields = Json::object();
    put_time(fields, report.stamp);
    fields.update(slam::to_json(report));
    events_.post({"loop", 0, std::move(fields)});
  }
  const slam::MapCorrection& now = backend_->correction();
  if (now.placed == before.placed && now.confidence == before.confidence &&
      now.epoch == before.epoch) {
    return;
  }
  crossings_.commands.post(now);
  if (now.epoch == before.epoch) return;
  const slam::MapSnapshot& map = *backend_->snapshot();
  events_.post({"map",
                0,
                {{"action", action != nullptr ? action : action_between(before, now)},
                 {"map_epoch", map.epoch},
                 {"revision", map.revision},
                 {"points", map.point_count},
                 {"keyframes", map.keyframe_count}}});
}

void BackendThread::publish() {
  auto state = std::make_shared<MapState>();
  state->map = backend_->snapshot();
  if (state->map == nullptr) state->map = std::make_shared<const slam::MapSnapshot>();
  state->memory = backend_->memory();
  state->backend = duration_;
  state->pgo = pgo_duration_;
  state->loops_accepted = backend_->loops_accepted();
  state->loops_rejected = backend_->loops_rejected();
  state->session_file = backend_->session_file().string();
  state->store_failures = backend_->store_failures();
  state->store_error = backend_->store_error();
  crossings_.map.store(std::move(state));
}

}  // namespace glint::daemon
