// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/merge/session_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "driver/core/error.hpp"
#include "slam/loops/place.hpp"
#include "slam/loops/vocabulary.hpp"
#include "slam/merge/map_join.hpp"
#include "slam/merge/merged_view.hpp"
#include "slam/moving_points.hpp"
#include "slam/store/session_copy.hpp"
#include "slam/store/session_map.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/temporary_file.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeyframesACommit = 100;

/// A session that waits to be joined.
struct Unjoined {
  fs::path file;
  std::unique_ptr<SessionReader> session;
};

std::list<Unjoined> open_all(std::span<const fs::path> files) {
  std::list<Unjoined> all;
  for (const fs::path& file : files) {
    all.push_back({file, std::make_unique<SessionReader>(file)});
    if (all.back().session->keyframe_count() > 0) continue;
    throw InputError(fmt::format("{} holds no keyframe; leave it out", file.string()));
  }
  return all;
}

// As the first session's back end chose, so far as it matters to a graph.
SlamConfig config_of(const SessionReader& session) {
  const std::string preset = session.meta("preset");
  return preset_config(preset == "paper" ? preset : "full");
}

NoOverlapError no_overlap(std::span<const fs::path> files, const std::list<Unjoined>& left) {
  std::string others;
  for (const fs::path& file : files) {
    if (std::ranges::any_of(left, [&](const Unjoined& u) { return u.file == file; })) continue;
    others += (others.empty() ? "" : ", ") + file.string();
  }
  return NoOverlapError(fmt::format(
      "{} shows no place that is seen in {}; record a session that passes through both, "
      "looks at each for some metres, and merge it with them",
      left.front().file.string(), others));
}

/// Takes from `waiting` what can be joined: a session may be laid onto one that came after it.
void join_all(std::span<const fs::path> files, std::list<Unjoined>& waiting,
              std::vector<std::unique_ptr<SessionReader>>& joined, MapJoin& map) {
  auto next = waiting.begin();
  while (next != waiting.end()) {
    if (!map.join(*next->session)) {
      ++next;
      continue;
    }
    joined.push_back(std::move(next->session));
    waiting.erase(next);
    next = waiting.begin();
  }
  if (!waiting.empty()) throw no_overlap(files, waiting);
}

void write_meta(const SessionReader& session, SessionStore& store) {
  for (const char* key : {"preset", "map_voxel_m", "map_max_points"}) {
    if (std::string value = session.meta(key); !value.empty()) {
      store.set_meta(key, std::move(value));
    }
  }
  const bool wanted = moving_in_session(session) == MovingInSession::kWanted;
  store.set_meta("moving_objects", wanted ? "kept" : "removed");
  store.set_meta("vocabulary_hash", fmt::format("{:016x}", default_vocabulary()->hash()));
}

/// A session's keyframes with the sensors that they are of.
class PartWriter {
 public:
  PartWriter(const JoinedSession& part, SessionStore& store)
      : sensors_(part.session->sensors()), first_keyframe_(part.first_keyframe), store_(store) {}

  void add(const Keyframe& keyframe, const Pose& T_map_sensor) {
    for (; next_ < sensors_.size(); ++next_) {
      if (sensors_[next_].first_keyframe + first_keyframe_ > keyframe.id) break;
      store_.set_sensor(sensors_[next_].info);
    }
    store_.add(keyframe, T_map_sensor,
               default_vocabulary()->bag_of(place_descriptors(keyframe.features)));
    // Sooner than a store that waits for its time refuses more.
    if (++added_ % kKeyframesACommit == 0) store_.commit();
  }

 private:
  const std::vector<SessionSensor> sensors_;
  const std::uint64_t first_keyframe_;
  SessionStore& store_;
  std::size_t next_ = 0;
  std::size_t added_ = 0;
};

void write_keyframes(const MapJoin& map, SessionStore& store, MergeSummary& summary) {
  MergedView view(map);
  std::size_t node = 0;
  for (std::size_t i = 0; i < map.sessions().size(); ++i) {
    PartWriter writer(map.sessions()[i], store);
    const auto moved = moving_in_session(*map.sessions()[i].session);
    MovingPoints moving;
    map.sessions()[i].for_each_keyframe([&](SessionKeyframe&& stored) {
      if (moved == MovingInSession::kToBeLeftOut) {
        stored.keyframe.points = moving.standing(stored.keyframe);
      }
      if (view.adds_nothing(node, i, stored.keyframe)) {
        stored.keyframe.points.clear();
        stored.keyframe.features.clear();
        ++summary.thinned;
      } else {
        ++summary.kept;
      }
      writer.add(stored.keyframe, map.graph().poses()[node++]);
    });
  }
}

void write_merged(const MapJoin& map, std::span<const fs::path> files, const fs::path& file,
                  Clock clock, MergeSummary& summary) {
  SessionStore store(file, {.clock = clock});
  write_meta(*map.sessions().front().session, store);
  write_keyframes(map, store, summary);
  LoopChanges changes;
  changes.added = map.graph().loops();
  nlohmann::json names = nlohmann::json::array();
  for (const fs::path& merged : files) names.push_back(merged.filename().string());
  const nlohmann::json event = {
      {"sessions", names}, {"kept", summary.kept}, {"thinned", summary.thinned}};
  changes.events.push_back(
      {map.sessions().back().session->poses().back().stamp, "merge", event.dump()});
  store.apply(changes);
  if (!store.commit() || store.failures() > 0) {
    throw InputError(fmt::format("cannot write {}: {}; choose a directory with room", file.string(),
                                 store.error()));
  }
}

}  // namespace

MergeSummary merge_sessions(std::span<const fs::path> sessions, const fs::path& target,
                            Clock clock) {
  const std::int64_t start_ns = clock.monotonic_ns();
  std::list<Unjoined> waiting = open_all(sessions);
  std::vector<std::unique_ptr<SessionReader>> joined;
  joined.push_back(std::move(waiting.front().session));
  waiting.pop_front();
  MapJoin map(config_of(*joined.front()), default_vocabulary());
  map.begin(*joined.front());
  join_all(sessions, waiting, joined, map);

  MergeSummary summary;
  // A session that is written keeps a log beside it: it is made under a name of its own, and what
  // gets the target's is one file.
  const TemporaryFile temporary(target.string() + ".merge");
  write_merged(map, sessions, temporary.path(), clock, summary);
  copy_session(temporary.path(), target, clock);
  summary.sessions = joined.size();
  summary.joints = map.joint_count();
  summary.loops = map.graph().loop_count();
  summary.seconds = static_cast<double>(clock.monotonic_ns() - start_ns) * kSecondsPerNs;
  return summary;
}

}  // namespace glint::slam
