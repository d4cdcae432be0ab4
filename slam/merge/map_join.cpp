// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/merge/map_join.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "slam/loops/relocalizer.hpp"

namespace glint::slam {
namespace {

// An edge says most of what those just after it would.
constexpr double kJointEvery_m = 1.0;
// So many that agree with one another tie a session to the map.
constexpr std::size_t kLeastJoints = 3;

std::size_t joints_to(const PoseGraph& graph, std::uint64_t first_keyframe) {
  return static_cast<std::size_t>(std::ranges::count_if(graph.loops(), [&](const LoopEdge& edge) {
    return edge.from < first_keyframe && edge.to >= first_keyframe;
  }));
}

}  // namespace

void JoinedSession::for_each_keyframe(const std::function<void(SessionKeyframe&&)>& take) const {
  session->for_each_keyframe([&](SessionKeyframe&& keyframe) {
    keyframe.keyframe.id += first_keyframe;
    keyframe.keyframe.estimate.segment += first_segment;
    take(std::move(keyframe));
  });
}

/// Where a session's keyframes see those of the map.
struct MapJoin::Sights {
  std::vector<LoopEdge> edges;
  std::optional<Pose> T_map_session;  ///< As the first place has it; null where there is none.
};

MapJoin::MapJoin(const SlamConfig& config, std::shared_ptr<const Vocabulary> vocabulary)
    : config_(config), vocabulary_(std::move(vocabulary)) {}

JoinedSession MapJoin::numbered(const SessionReader& session) const {
  JoinedSession part{&session, 0, 0};
  if (!graph_ || graph_->nodes().empty()) return part;
  part.first_keyframe = graph_->nodes().back().id + 1;
  for (const GraphNode& node : graph_->nodes()) {
    part.first_segment = std::max(part.first_segment, node.segment + 1);
  }
  return part;
}

void MapJoin::add_part(const JoinedSession& part, const Pose& T_map_session, PoseGraph& graph) {
  part.for_each_keyframe([&](SessionKeyframe&& stored) {
    graph.add_at(stored.keyframe, T_map_session * stored.T_map_sensor);
  });
  for (LoopEdge& loop : part.session->loop_edges()) {
    loop.from += part.first_keyframe;
    loop.to += part.first_keyframe;
    graph.restore_loop(loop);
  }
}

void MapJoin::begin(const SessionReader& session) {
  graph_ =
      std::make_unique<PoseGraph>(PoseGraphOptions{config_.pgo_gravity, config_.loop_consistency});
  sessions_ = {{&session, 0, 0}};
  add_part(sessions_.front(), {}, *graph_);
}

// The places are looked for where the sessions before have been laid by now.
MapJoin::Sights MapJoin::look_for(const JoinedSession& part) const {
  Relocalizer map(vocabulary_);
  auto pose = graph_->poses().begin();
  for (const JoinedSession& before : sessions_) {
    before.for_each_keyframe(
        [&](SessionKeyframe&& stored) { map.remember(stored.keyframe, *pose++); });
  }
  Sights sights;
  std::uint64_t next = 0;
  std::optional<std::pair<std::uint32_t, Pose>> last;
  part.for_each_keyframe([&](SessionKeyframe&& stored) {
    const auto found = map.locate(stored.keyframe);
    if (!found) return;
    if (!sights.T_map_session) {
      sights.T_map_session = found->T_map_sensor * stored.T_map_sensor.inverse();
    }
    const std::uint32_t segment = stored.keyframe.estimate.segment;
    for (const PlaceSighting& sighting : found->sightings) {
      if (sighting.edge.to < next) continue;
      const Eigen::Vector3d& at_m = sighting.T_odom_sensor.translation_m;
      if (last && last->first == segment &&
          (at_m - last->second.translation_m).norm() < kJointEvery_m) {
        continue;
      }
      sights.edges.push_back(sighting.edge);
      next = sighting.edge.to + 1;
      last = {segment, sighting.T_odom_sensor};
    }
  });
  return sights;
}

bool MapJoin::join(const SessionReader& session) {
  const JoinedSession part = numbered(session);
  const Sights sights = look_for(part);
  if (!sights.T_map_session) return false;
  auto graph = std::make_unique<PoseGraph>(*graph_);
  add_part(part, *sights.T_map_session, *graph);
  for (const LoopEdge& edge : sights.edges) {
    if (graph->misfit(edge)) graph->add_loop(edge);
  }
  graph->optimize();
  if (joints_to(*graph, part.first_keyframe) < kLeastJoints) return false;
  graph_ = std::move(graph);
  sessions_.push_back(part);
  return true;
}

std::size_t MapJoin::joint_count() const {
  const auto session_of = [&](std::uint64_t keyframe) {
    return std::ranges::upper_bound(sessions_, keyframe, {}, &JoinedSession::first_keyframe);
  };
  return static_cast<std::size_t>(std::ranges::count_if(
      graph_->loops(), [&](const LoopEdge& e) { return session_of(e.from) != session_of(e.to); }));
}

}  // namespace glint::slam
