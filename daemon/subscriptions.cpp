// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/subscriptions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glint::daemon {
namespace {

constexpr std::size_t kMaxWaiting = 64;
constexpr double kMinRateHz = 0.01;
constexpr double kMaxRateHz = 1000.0;
constexpr double kDefaultStatusRateHz = 1.0;
constexpr double kMaxStatusRateHz = 10.0;

struct Topics {
  bool pose = false;
  bool status = false;
  bool events = false;
  bool map = false;
  bool image = false;
};

Topics parse_topics(const Json& params, bool required) {
  const Json* list = find_param(params, "topics");
  if (list == nullptr && !required) return {true, true, true, true, true};
  Topics topics;
  const std::array<std::pair<const char*, bool*>, 5> names{{{"pose", &topics.pose},
                                                            {"status", &topics.status},
                                                            {"events", &topics.events},
                                                            {"map", &topics.map},
                                                            {"image", &topics.image}}};
  const auto note = [&](const Json& topic) {
    const auto* const name =
        std::ranges::find_if(names, [&](const auto& n) { return topic == n.first; });
    if (name == names.end()) return false;
    *name->second = true;
    return true;
  };
  const bool ok =
      list != nullptr && list->is_array() && !list->empty() && std::ranges::all_of(*list, note);
  if (ok) return topics;
  throw RpcError(kInvalidParams, "topics must be a list of pose, status, events, map, image",
                 "topics");
}

std::int64_t period_ns(double rate_hz) { return std::llround(1e9 / rate_hz); }

}  // namespace

Json Subscriptions::subscribe(const Json& params) {
  const Topics topics = parse_topics(params, true);
  const PoseFrames frames = pose_frames(params);
  const double asked_hz = number_param(params, "rate_hz", 0.0, kMinRateHz, kMaxRateHz);
  // These may refuse their parameters: nothing has changed then.
  std::unique_ptr<ToldByWorker> map =
      topics.map ? tell_map(api_, params, asked_hz, on_line_) : nullptr;
  std::unique_ptr<ToldByWorker> image =
      topics.image ? tell_images(api_, params, asked_hz, on_line_) : nullptr;
  if (map) map_ = std::move(map);
  if (image) image_ = std::move(image);
  if (topics.pose) {
    PoseTopic topic;
    topic.frames = frames;
    const bool every_scan = asked_hz == 0.0 || asked_hz >= api_.scan_rate_hz();
    topic.rate_hz = every_scan ? api_.scan_rate_hz() : asked_hz;
    topic.period_ns = every_scan ? 0 : period_ns(asked_hz);
    pose_ = std::move(topic);
  }
  if (topics.status) {
    StatusTopic topic;
    topic.rate_hz = std::min(asked_hz == 0.0 ? kDefaultStatusRateHz : asked_hz, kMaxStatusRateHz);
    topic.period_ns = period_ns(topic.rate_hz);
    status_ = topic;
  }
  if (topics.events) {
    const std::uint64_t begin = api_.events().end();
    events_ = EventTopic{begin, begin, 0};
  }
  return echo();
}

Json Subscriptions::unsubscribe(const Json& params) {
  const Topics topics = parse_topics(params, false);
  if (topics.pose) pose_.reset();
  if (topics.status) status_.reset();
  if (topics.events) events_.reset();
  if (topics.map) map_.reset();
  if (topics.image) image_.reset();
  return echo();
}

Json Subscriptions::echo() const {
  Json topics = Json::array();
  Json settings = Json::object();
  if (pose_) {
    topics.push_back("pose");
    settings["pose"] = Json{{"rate_hz", pose_->rate_hz},
                            {"every_scan", pose_->period_ns == 0},
                            {"frame", pose_->frames.map ? "map" : "odom"},
                            {"child", pose_->frames.base ? "base" : "sensor"}};
  }
  if (status_) {
    topics.push_back("status");
    settings["status"] = Json{{"rate_hz", status_->rate_hz}};
  }
  if (events_) {
    topics.push_back("events");
    settings["events"] = Json::object();
  }
  if (map_) {
    topics.push_back("map");
    settings["map"] = map_->settings();
  }
  if (image_) {
    topics.push_back("image");
    settings["image"] = image_->settings();
  }
  Json out = api_.head();
  out["topics"] = std::move(topics);
  out["settings"] = std::move(settings);
  return out;
}

void Subscriptions::offer(const std::shared_ptr<const Snapshot>& snapshot) {
  if (!pose_) return;
  const std::int64_t stamp_ns = snapshot->estimate->stamp.ns;
  if (pose_->period_ns > 0) {
    // A clock that went back, or stood still for long, starts the rhythm anew.
    const std::int64_t ahead_ns = pose_->next_due_ns - stamp_ns;
    if (std::abs(ahead_ns) > 2 * pose_->period_ns) pose_->next_due_ns = stamp_ns;
    if (stamp_ns < pose_->next_due_ns) return;
    pose_->next_due_ns += pose_->period_ns;
  }
  if (pose_->waiting.size() == kMaxWaiting) {
    pose_->waiting.pop_front();
    ++pose_->missed;
    ++counters_.missed_notifications;
  }
  pose_->waiting.push_back({pose_->seq++, snapshot});
}

void Subscriptions::tick(std::int64_t now_ns) {
  for (ToldByWorker* const topic : {map_.get(), image_.get()}) {
    if (topic != nullptr && topic->tick(now_ns)) ++counters_.missed_notifications;
  }
  if (!status_ || now_ns < status_->next_due_ns) return;
  status_->next_due_ns += status_->period_ns;
  if (status_->next_due_ns <= now_ns) status_->next_due_ns = now_ns + status_->period_ns;
  // The status is made when it is sent, so one that still waits is replaced by the newer one.
  if (std::exchange(status_->waiting, true)) {
    ++status_->missed;
    ++counters_.missed_notifications;
  }
  ++status_->seq;
}

std::optional<std::string> Subscriptions::next_line() {
  auto line = next_event();  // They are few, and the newest poses come soon enough.
  if (!line) line = next_pose();
  if (!line) line = next_status();
  if (!line && image_) line = image_->take_line();
  if (!line && map_) line = map_->take_line();
  return line;
}

std::optional<std::string> Subscriptions::next_event() {
  if (!events_) return std::nullopt;
  const std::uint64_t wanted = events_->next;
  auto event = api_.events().next(events_->next);
  if (!event) return std::nullopt;
  const std::uint64_t number = events_->next - 1;
  events_->missed += number - wanted;
  counters_.missed_notifications += number - wanted;
  Json params{{"sensor", event->sensor}, {"kind", std::move(event->kind)}};
  params.update(event->fields);
  params["seq"] = number - events_->begin;
  params["missed"] = events_->missed;
  return notification_line("event", params);
}

std::optional<std::string> Subscriptions::next_pose() {
  if (!pose_ || pose_->waiting.empty()) return std::nullopt;
  const WaitingPose waiting = std::move(pose_->waiting.front());
  pose_->waiting.pop_front();
  return numbered_notification_line("pose", api_.pose_text(waiting.snapshot, pose_->frames),
                                    waiting.seq, pose_->missed);
}

std::optional<std::string> Subscriptions::next_status() {
  if (!status_ || !std::exchange(status_->waiting, false)) return std::nullopt;
  Json params = api_.status();
  params["seq"] = status_->seq - 1;
  params["missed"] = status_->missed;
  return notification_line("status", params);
}

}  // namespace glint::daemon
