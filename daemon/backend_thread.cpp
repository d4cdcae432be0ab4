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
// While a map is still being read; other threads want the processor, too.
constexpr std::chrono::milliseconds kRestoringWait{10};

// What has happened to the map, or to the sensor in one that is only read.
const char* action_between(const slam::MapCorrection& before, const slam::MapCorrection& now,
                           slam::MapUse use) {
  if (!now.placed) return "searching";
  const bool moved = before.placed && use == slam::MapUse::kExtend;
  return moved ? "corrected" : "located";
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
      backend_(make_backend_stored_or_not()) {
  tell({}, backend_->correction().placed ? nullptr : "loaded");
}

std::unique_ptr<slam::Backend> BackendThread::make_backend() const {
  const bool grows = plan_.use == slam::MapUse::kExtend;
  auto backend = std::make_unique<slam::Backend>(
      config_, plan_.file, stage_clock(), grows && make_loops_ ? make_loops_() : slam::LoopSource{},
      plan_.earlier, plan_.use, [this] { heartbeat_.beat(); });
  if (config_.loops) backend->search_new_segments();
  return backend;
}

// A disk that takes no new file is no reason to stand still: the robot still needs its pose. An
// earlier map that cannot be read is one, for going on without it is not what was asked for.
std::unique_ptr<slam::Backend> BackendThread::make_backend_stored_or_not() {
  no_session_because_.clear();
  try {
    return make_backend();
  } catch (const InputError& error) {
    if (plan_.file.empty() || !plan_.earlier.empty()) throw;
    no_session_because_ = error.what();
    spdlog::error("no session is kept: {}", no_session_because_);
    plan_.file.clear();
    return make_backend();
  }
}

void BackendThread::run() {
  using PopResult = BoundedQueue<slam::Keyframe>::PopResult;
  slam::Keyframe keyframe;
  PopResult result = PopResult::kTimeout;
  while (result != PopResult::kClosed) {
    heartbeat_.beat();
    const bool restoring = backend_->restored() < 1.0;
    result = crossings_.keyframes.pop(keyframe, restoring ? kRestoringWait : kKeyframeWait);
    look_at_sensor();
    if (result == PopResult::kItem) {
      process(keyframe);
    } else if (restoring) {
      restore_more();
    }
    keep_session();
    crossings_.session_commit.serve([this] { return commit_session(); });
    if (const auto change = crossings_.map_change.take()) change_map(*change);
    if (const auto request = crossings_.place_search.take()) search_anew(*request);
  }
  const slam::MapCorrection before = backend_->correction();
  backend_->finish(slam::Ending::kSoon);
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
  if (backend_->guess_dropped()) post_map_event("guess_dropped");
  if (backend_->search() == slam::MapSearch::kNone) told_not_found_ = false;
  if (backend_->searching_s() > plan_.search_s) take_end_of_search();
}

void BackendThread::restore_more() {
  const slam::MapCorrection before = backend_->correction();
  if (backend_->restore_more()) tell(before);
}

void BackendThread::search_anew(const PlaceSearchRequest& request) {
  const slam::MapCorrection before = backend_->correction();
  told_not_found_ = false;
  if (!backend_->search_anew(request.guess)) {
    return spdlog::warn("the sensor's place is not looked for: no session tells of the map");
  }
  tell(before);
}

// The sensor was not found for so long as it is looked for.
void BackendThread::take_end_of_search() {
  switch (backend_->search()) {
    case slam::MapSearch::kEarlierMap:
      return begin_another_map();
    case slam::MapSearch::kOwnMap: {
      const slam::MapCorrection before = backend_->correction();
      backend_->go_on_unfound();
      return tell(before, "not_found");
    }
    default:
      if (std::exchange(told_not_found_, true)) return;
      spdlog::warn("the sensor was not found in the map for {:.0f} s; the search goes on",
                   plan_.search_s);
      post_map_event("not_found");
  }
}

// The map there is now stays until the other one is there.
void BackendThread::change_map(const MapChange& change) {
  const slam::MapCorrection before = backend_->correction();
  const SessionPlan plan_before = std::exchange(plan_, change.plan);
  try {
    std::unique_ptr<slam::Backend> other = make_backend();
    backend_->finish(slam::Ending::kSoon);
    backend_ = std::move(other);
    no_session_because_.clear();
  } catch (const std::exception& error) {
    plan_ = plan_before;
    return change.job->fail(error.what());
  }
  backend_->begin_at_epoch(before.epoch + 1);
  told_not_found_ = false;
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
  backend_ = make_backend_stored_or_not();
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
  if (last->correction.same_as(backend_->correction())) return;
  const bool same_epoch = last->correction.epoch == backend_->correction().epoch;
  auto corrected = std::make_shared<Snapshot>(*last);
  corrected->correction = backend_->correction();
  crossings_.snapshot.store(corrected);
  if (same_epoch) return;
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
  if (now.same_as(before)) return;
  crossings_.commands.post(now);
  if (now.epoch == before.epoch) return;
  post_map_event(action != nullptr ? action : action_between(before, now, plan_.use));
}

void BackendThread::post_map_event(const char* action) {
  const slam::MapSnapshot& map = *backend_->snapshot();
  events_.post({"map",
                0,
                {{"action", action},
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
  state->restored = backend_->restored();
  state->unreadable_keyframes = backend_->unreadable_keyframes();
  state->only_read = plan_.use == slam::MapUse::kLocalize;
  state->session_file = backend_->session_file().string();
  state->store_failures = backend_->store_failures();
  state->store_error = backend_->store_error();
  if (!no_session_because_.empty()) {
    ++state->store_failures;
    state->store_error = no_session_because_;
  }
  crossings_.map.store(std::move(state));
}

}  // namespace glint::daemon
