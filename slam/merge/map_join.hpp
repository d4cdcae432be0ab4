// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "slam/config.hpp"
#include "slam/loop_edge.hpp"
#include "slam/loops/vocabulary.hpp"
#include "slam/pose_graph.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::slam {

/// A session whose keyframes and segments have numbers of a map of several.
struct JoinedSession {
  const SessionReader* session = nullptr;
  std::uint64_t first_keyframe = 0;  ///< Added to the session's own numbers.
  std::uint32_t first_segment = 0;

  /// Calls `take` with each keyframe under its number in the map, in order; its T_map_sensor is
  /// that of the session. @throws InputError as SessionReader.
  void for_each_keyframe(const std::function<void(SessionKeyframe&&)>& take) const;
};

/// Lays sessions into one another: keyframes of one that see a place of those before tie it to
/// them, wherever it began and whichever way it looked. The frame is that of the first session's
/// map. A session of another place is not joined. Deterministic. Thread-compatible.
class MapJoin {
 public:
  MapJoin(const SlamConfig& config, std::shared_ptr<const Vocabulary> vocabulary);

  /// The session that all others are laid onto; it must outlive this object.
  /// @throws InputError where it cannot be read, as join() does.
  void begin(const SessionReader& session);
  /// False where it shows no place of those before; nothing has changed then.
  bool join(const SessionReader& session);

  /// In the order in which they were joined.
  [[nodiscard]] const std::vector<JoinedSession>& sessions() const { return sessions_; }
  [[nodiscard]] const PoseGraph& graph() const { return *graph_; }
  /// Edges of the graph between two sessions.
  [[nodiscard]] std::size_t joint_count() const;

 private:
  struct Sights;

  [[nodiscard]] JoinedSession numbered(const SessionReader& session) const;
  [[nodiscard]] Sights look_for(const JoinedSession& part) const;
  static void add_part(const JoinedSession& part, const Pose& T_map_session, PoseGraph& graph);

  const SlamConfig config_;
  const std::shared_ptr<const Vocabulary> vocabulary_;
  std::unique_ptr<PoseGraph> graph_;
  std::vector<JoinedSession> sessions_;
};

}  // namespace glint::slam
