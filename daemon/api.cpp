// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <random>

#include "daemon/map_saving.hpp"
#include "daemon/metrics_text.hpp"
#include "daemon/protocol_image.hpp"
#include "daemon/protocol_map.hpp"
#include "daemon/protocol_place.hpp"
#include "daemon/sensor_link.hpp"
#include "daemon/session_files.hpp"
#include "daemon/version.hpp"

namespace glint::daemon {
namespace {

/// What hello announces: only what works.
constexpr std::array kFeatures = {"authenticate",        "get_pose",        "get_pose.at_ns",
                                  "get_pose.predict_ms", "get_status",      "get_metrics",
                                  "get_image",           "get_map",         "get_trajectory",
                                  "get_config",          "subscribe.pose",  "subscribe.status",
                                  "subscribe.events",    "subscribe.map",   "subscribe.image",
                                  "unsubscribe",         "pause",           "resume",
                                  "reset_odometry",      "save_map",        "list_maps",
                                  "delete_map",          "load_map",        "clear_map",
                                  "relocalize",          "set_initial_pose"};

/// How long a first look waits for a scan, and how much of that the queries of others wait, too.
constexpr std::int64_t kImageWaitNs = 1'000'000'000;
constexpr std::chrono::milliseconds kImageStep{10};

/// A pose as text is told to all for so long: its age is not older than that.
constexpr std::int64_t kPoseTextNs = 10'000'000;

/// Tells one run of the daemon from the next.
std::string random_instance() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

/// The reply's line. @throws RpcError.
std::string checked_line(const Json& id, const Json& result) {
  std::string line = result_line(id, result);
  if (line.size() > kMaxLineBytes) {
    throw RpcError(kTooLarge, "the answer is longer than the longest line; ask for less");
  }
  return line;
}

std::string map_name_param(const Json& params) {
  const Json* name = find_param(params, "name");
  if (name != nullptr && name->is_string() && SavedMaps::is_name(name->get<std::string>())) {
    return name->get<std::string>();
  }
  throw RpcError(kInvalidParams, fmt::format("name must be {}", SavedMaps::kNameRule), "name");
}

/// All maps, one a step: a large one's pages may be slow to come.
class MapList {
 public:
  explicit MapList(SavedMaps maps) : maps_(std::move(maps)) {}

  std::optional<Json> step() {
    if (!names_) names_ = maps_.names();
    if (described_.size() == names_->size()) return Json{{"maps", std::move(described_)}};
    const std::string& name = (*names_)[described_.size()];
    Json map{{"name", name}};
    map.update(describe_session(maps_.file_of(name)));
    described_.push_back(std::move(map));
    return std::nullopt;
  }

 private:
  const SavedMaps maps_;
  std::optional<std::vector<std::string>> names_;
  Json described_ = Json::array();
};

}  // namespace

Api::Api(boost::asio::io_context& io, Runtime& runtime, const Config& config)
    : io_(io),
      runtime_(runtime),
      config_(config),
      instance_(random_instance()),
      start_ns_(steady_now_ns()),
      maps_(state_directory(config)) {}

Api::Method Api::find_method(std::string_view name) {
  struct Entry {
    std::string_view name;
    Method method;
  };
  static constexpr std::array<Entry, 13> kMethods = {
      {{"get_pose", &Api::call_get_pose},
       {"get_status", &Api::call_get_status},
       {"get_metrics", &Api::call_get_metrics},
       {"get_trajectory", &Api::call_get_trajectory},
       {"get_config", &Api::call_get_config},
       {"pause", &Api::call_pause},
       {"resume", &Api::call_resume},
       {"reset_odometry", &Api::call_reset_odometry},
       {"save_map", &Api::call_save_map},
       {"load_map", &Api::call_load_map},
       {"clear_map", &Api::call_clear_map},
       {"relocalize", &Api::call_relocalize},
       {"set_initial_pose", &Api::call_set_initial_pose}}};
  const auto* found = std::ranges::find(kMethods, name, &Entry::name);
  return found == kMethods.end() ? nullptr : found->method;
}

Api::WorkerMethod Api::find_worker_method(std::string_view name) {
  if (name == "get_map") return &Api::call_get_map;
  if (name == "get_image") return &Api::call_get_image;
  if (name == "list_maps") return &Api::call_list_maps;
  if (name == "delete_map") return &Api::call_delete_map;
  return nullptr;
}

void Api::call(const Request& request, Reply reply) {
  if (const WorkerMethod method = find_worker_method(request.method)) {
    const auto line = [id = request.id, head = head()](const Json& fields) {
      Json result = head;
      result.update(fields);
      return checked_line(id, result);
    };
    const auto refusal = [id = request.id](const RpcError& error) { return error_line(id, error); };
    return run_on_worker(std::make_shared<WorkerCall>(
        WorkerCall{(this->*method)(request.params), line, refusal, std::move(reply)}));
  }
  const Method method = find_method(request.method);
  if (method == nullptr) {
    throw RpcError(kMethodNotFound, fmt::format("there is no method '{}'", request.method),
                   "method");
  }
  reply(checked_line(request.id, (this->*method)(request.params)));
}

void Api::make(Notification notification, Reply reply) {
  Json params = head();
  params.update(notification.params);
  const auto line = [method = std::move(notification.method), params](const Json& fields) {
    if (fields.empty()) return std::string();
    Json all = params;
    all.update(fields);
    return notification_line(method, all);
  };
  const auto refusal = [](const RpcError&) { return std::string(); };
  try {
    run_on_worker(std::make_shared<WorkerCall>(
        WorkerCall{std::move(notification.step), line, refusal, reply}));
  } catch (const RpcError&) {
    boost::asio::post(io_, [reply] { reply({}); });
  }
}

void Api::run_on_worker(const std::shared_ptr<WorkerCall>& call) {
  const bool submitted = runtime_.submit([this, call] {
    auto line = take_step(*call);
    boost::asio::post(io_, [this, call, line = std::move(line)]() mutable {
      if (line) return call->reply(std::move(*line));
      try {
        run_on_worker(call);
      } catch (const RpcError& error) {
        call->reply(call->refusal(error));
      }
    });
  });
  if (!submitted) throw RpcError(kBusy, "too many queries are waiting; ask again");
}

// Nothing may leave it: who runs on the worker has nobody to tell but the client.
std::optional<std::string> Api::take_step(const WorkerCall& call) {
  try {
    const auto fields = call.step();
    if (!fields) return std::nullopt;
    return call.line(*fields);
  } catch (const RpcError& error) {
    return call.refusal(error);
  } catch (const std::exception& error) {
    return call.refusal(RpcError(kInternalError, error.what()));
  }
}

std::string Api::hello_line(bool asks_token) const {
  const auto snapshot = runtime_.snapshot();
  return notification_line("hello", Json{{"protocol", "1.0"},
                                         {"server", fmt::format("glintd {}", kVersion)},
                                         {"instance", instance_},
                                         {"map_epoch", snapshot->correction.epoch},
                                         {"max_line", kMaxLineBytes},
                                         {"authentication", asks_token ? "token" : "none"},
                                         {"features", kFeatures}});
}

PoseContext Api::context() const {
  return {config_.mount.T_base_sensor, runtime_.scan_period_ns()};
}

Json Api::status() const {
  ServiceStatus service;
  service.instance = instance_;
  service.source_name = runtime_.options().source_name;
  service.uptime_ns = steady_now_ns() - start_ns_;
  service.scan_period_ns = runtime_.scan_period_ns();
  if (sensor_ != nullptr) {
    service.session = &sensor_->status();
    service.sensor_problem = sensor_->problem();
  }
  service.clients = client_count_;
  service.server = server_counters_;
  service.sessions_removed = sessions_removed_;
  return status_json(runtime_.status(), service, steady_now_ns());
}

std::string Api::metrics() const { return metrics_text(status(), all_stages(runtime_.status())); }

std::string Api::health_problem() const {
  if (std::string fault = runtime_.fault(); !fault.empty()) return fault;
  return runtime_.alive(kThreadLimitNs) ? "" : "a thread has given no sign of life for ten seconds";
}

Json Api::pose(const Snapshot& snapshot, PoseFrames frames) const {
  return newest_pose_json(snapshot, frames, context(), steady_now_ns());
}

const std::string& Api::pose_text(const std::shared_ptr<const Snapshot>& snapshot,
                                  PoseFrames frames) {
  PoseText& pose_text = pose_texts_.at((frames.map ? 1U : 0U) + (frames.base ? 2U : 0U));
  const std::int64_t now_ns = steady_now_ns();
  if (pose_text.snapshot != snapshot || now_ns - pose_text.made_ns > kPoseTextNs) {
    pose_text = {snapshot, now_ns, pose(*snapshot, frames).dump()};
  }
  return pose_text.text;
}

Json Api::head() const {
  const auto snapshot = runtime_.snapshot();
  const auto state = client_state(*snapshot, steady_now_ns(), runtime_.scan_period_ns());
  Json out{{"sensor", 0}, {"state", slam::to_string(state)}};
  if (snapshot->estimate) put_time(out, snapshot->estimate->stamp);
  out["map_epoch"] = snapshot->correction.epoch;
  return out;
}

Json Api::call_get_pose(const Json& params) {
  return get_pose(params, *runtime_.snapshot(), context(), steady_now_ns());
}

Json Api::call_get_status(const Json&) { return status(); }

Json Api::call_get_metrics(const Json&) {
  Json out = head();
  out["content_type"] = "text/plain; version=0.0.4";
  out["text"] = metrics();
  return out;
}

Json Api::call_get_trajectory(const Json& params) {
  return get_trajectory(params, *runtime_.snapshot(), context(), steady_now_ns());
}

Json Api::call_get_config(const Json&) {
  Json out = head();
  out["config"] = to_json(config_);
  return out;
}

Json Api::call_pause(const Json&) { return post_command(PauseCommand{}); }
Json Api::call_resume(const Json&) { return post_command(ResumeCommand{}); }
Json Api::call_reset_odometry(const Json&) { return post_command(ResetOdometryCommand{}); }

Json Api::post_command(Command command) {
  runtime_.post(std::move(command));
  Json out = head();
  out["accepted"] = true;
  return out;
}

void Api::refuse_job() const {
  const auto running = runtime_.jobs().running();
  if (!running) throw RpcError(kBusy, "the daemon is stopping");
  throw RpcError(kBusy,
                 fmt::format("job {} ({}) is running; ask again when it has ended", running->id,
                             running->kind),
                 "", Json{{"job", job_json(*running)}});
}

Json Api::start_job(const std::string& kind, JobBody body) {
  const auto begun = runtime_.start_job(kind, std::move(body));
  if (!begun) refuse_job();
  Json out = head();
  out["accepted"] = true;
  out["job"] = job_json(*begun);
  return out;
}

Json Api::change_map(const std::string& kind, SessionPlan plan) {
  const std::shared_ptr<RunningJob> job = runtime_.jobs().begin(kind);
  if (!job) refuse_job();
  Json out = head();
  out["accepted"] = true;
  out["job"] = job_json(job->report());
  runtime_.change_map({std::move(plan), job});
  return out;
}

Json Api::call_load_map(const Json& params) {
  const std::string name = map_name_param(params);
  const bool extends = choice_param(params, "mode", "extend|localize") == "extend";
  expect_a_place_for_maps();
  if (!maps_.contains(name)) {
    throw RpcError(kNoSuchMap, fmt::format("there is no map '{}'; list_maps names all", name),
                   "name");
  }
  const std::filesystem::path file = maps_.file_of(name);
  return change_map("load_map",
                    extends ? plan_extension(config_, file) : plan_localization(config_, file));
}

Json Api::call_relocalize(const Json&) {
  expect_a_map_to_search();
  return search_place({});
}

Json Api::call_set_initial_pose(const Json& params) {
  expect_a_map_to_search();
  return search_place({parse_place_guess(params, config_.mount.T_base_sensor)});
}

Json Api::search_place(PlaceSearchRequest request) {
  runtime_.search_place(std::move(request));
  Json out = head();
  out["accepted"] = true;
  return out;
}

void Api::expect_a_map_to_search() const {
  const auto map = runtime_.status().map;
  if (!map->only_read && map->session_file.empty() && runtime_.snapshot()->correction.placed) {
    throw RpcError(kNotConfigured,
                   "no session is kept, without which the map cannot be searched: set "
                   "state.directory and start the daemon anew",
                   "state.directory");
  }
  if (map->map->keyframe_count == 0) {
    throw RpcError(kNotTracking, "there is no map yet in which the sensor could be looked for");
  }
}

Json Api::call_clear_map(const Json&) {
  return change_map("clear_map", plan_session_anew(config_));
}

void Api::expect_a_place_for_maps() const {
  if (maps_.has_place()) return;
  throw RpcError(kNotConfigured,
                 "there is no place for maps: set state.directory and start the daemon anew",
                 "state.directory");
}

Json Api::call_save_map(const Json& params) {
  const auto map = runtime_.status().map;
  MapSaving saving{map->session_file, map_name_param(params), maps_};
  expect_a_place_for_maps();
  if (map->map->keyframe_count == 0) {
    throw RpcError(kNotTracking, "there is no keyframe yet, so there is no map to save");
  }
  if (map->only_read) {
    throw RpcError(kNotTracking, "the map is only read, so there is nothing new to save");
  }
  if (map->session_file.empty()) {
    throw RpcError(kNotTracking,
                   "the sensor has not been found in the map yet, so there is nothing new to save");
  }
  return start_job("save_map", [this, saving = std::move(saving)](RunningJob& job) {
    return save_map(saving, runtime_, job);
  });
}

Api::WorkerStep Api::call_get_map(const Json& params) {
  return [this, query = parse_map_query(params)]() -> std::optional<Json> {
    return map_page(query, *runtime_.status().map->map);
  };
}

Api::WorkerStep Api::call_get_image(const Json& params) {
  const std::int64_t begin_ns = steady_now_ns();
  runtime_.scan_tap().ask(begin_ns);
  return [this, kind = image_kind(params), begin_ns]() -> std::optional<Json> {
    if (const auto tapped = runtime_.scan_tap().latest(kImageStep)) {
      return images_.json(tapped, kind);
    }
    if (steady_now_ns() - begin_ns < kImageWaitNs) return std::nullopt;
    throw RpcError(kNotTracking, "no scan came within a second, so there is no image");
  };
}

// An image that cannot be is told like one: who subscribed would wait for ever.
Api::WorkerStep Api::next_image(const std::string& kind,
                                std::shared_ptr<std::optional<SensorTime>> told) {
  const std::int64_t begin_ns = steady_now_ns();
  runtime_.scan_tap().ask(begin_ns);
  return [this, kind, begin_ns, told = std::move(told)]() -> std::optional<Json> {
    const auto tapped = runtime_.scan_tap().latest(kImageStep);
    if (!tapped && steady_now_ns() - begin_ns < kImageWaitNs) return std::nullopt;
    if (!tapped || *told == tapped->stamp) return Json::object();
    *told = tapped->stamp;
    try {
      return images_.json(tapped, kind);
    } catch (const RpcError& error) {
      return Json{{"kind", kind}, {"error", error.to_json()}};
    }
  };
}

Api::WorkerStep Api::call_list_maps(const Json&) {
  expect_a_place_for_maps();
  return [list = std::make_shared<MapList>(maps_)] { return list->step(); };
}

Api::WorkerStep Api::call_delete_map(const Json& params) {
  const std::string name = map_name_param(params);
  expect_a_place_for_maps();
  return [maps = maps_, name]() -> std::optional<Json> {
    if (!maps.remove(name)) {
      throw RpcError(kNoSuchMap, fmt::format("there is no map '{}'; list_maps names all", name),
                     "name");
    }
    return Json{{"deleted", name}};
  };
}

}  // namespace glint::daemon
