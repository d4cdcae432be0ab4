// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_writer.hpp"

namespace glint::slam {

SessionWriter::SessionWriter(const Database& database)
    : add_keyframe_(database,
                    "INSERT INTO keyframes (id, t_ns, frame_id, segment, T_odom_sensor, "
                    "T_map_sensor, sequence, state, completeness, covariance, gravity) "
                    "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      add_points_(database, "INSERT INTO clouds VALUES (?, ?)"),
      add_features_(database, "INSERT INTO features VALUES (?, ?)"),
      add_words_(database, "INSERT INTO words VALUES (?, ?)"),
      add_edge_(database,
                "INSERT INTO edges (from_keyframe, to_keyframe, kind, T_from_to, covariance) "
                "VALUES (?, ?, ?, ?, ?)"),
      remove_loop_(database,
                   "DELETE FROM edges WHERE kind = 'loop' AND from_keyframe = ? "
                   "AND to_keyframe = ?"),
      add_event_(database, "INSERT INTO events (t_ns, kind, data) VALUES (?, ?, ?)"),
      put_meta_(database, "INSERT OR REPLACE INTO meta VALUES (?, ?)"),
      put_sensor_(database, "INSERT OR REPLACE INTO sensors VALUES (?, ?)"),
      move_(database, "UPDATE keyframes SET T_map_sensor = ? WHERE id = ?") {}

void SessionWriter::write(const SessionRecord& record) {
  std::visit([this](const auto& of_its_kind) { put(of_its_kind); }, record);
}

void SessionWriter::move(std::uint64_t id, const Pose& T_map_sensor) {
  const PoseBytes pose = encode_pose(T_map_sensor);
  move_.run(std::span<const std::byte>(pose), id);
}

void SessionWriter::put(const KeyframeRecord& keyframe) {
  const OdometryEstimate& estimate = keyframe.estimate;
  const PoseBytes odom = encode_pose(estimate.T_odom_sensor);
  const PoseBytes map = encode_pose(keyframe.T_map_sensor);
  const CovarianceBytes covariance = encode_covariance(estimate.covariance);
  const auto insert = [&](const auto& gravity) {
    add_keyframe_.run(keyframe.id, estimate.stamp.ns, estimate.frame_id, estimate.segment,
                      std::span<const std::byte>(odom), std::span<const std::byte>(map),
                      estimate.sequence, to_string(estimate.state), estimate.completeness,
                      std::span<const std::byte>(covariance), gravity);
  };
  if (keyframe.gravity) {
    const GravityBytes gravity = encode_gravity(*keyframe.gravity);
    insert(std::span<const std::byte>(gravity));
  } else {
    insert(nullptr);
  }
  add_points_.run(keyframe.id, std::span<const std::byte>(keyframe.points));
  add_features_.run(keyframe.id, std::span<const std::byte>(keyframe.features));
  if (keyframe.words) add_words_.run(keyframe.id, std::span<const std::byte>(*keyframe.words));
  if (keyframe.odometry) put_edge(*keyframe.odometry, "odometry");
}

void SessionWriter::put(const MetaRecord& meta) { put_meta_.run(meta.key, meta.value); }

void SessionWriter::put(const SensorRecord& sensor) {
  put_sensor_.run(sensor.first_keyframe, sensor.metadata);
}

void SessionWriter::put(const LoopChanges& changes) {
  for (const LoopEdge& loop : changes.added) put_edge(loop, "loop");
  for (const LoopEdge& loop : changes.removed) remove_loop_.run(loop.from, loop.to);
  for (const SessionEvent& event : changes.events) {
    add_event_.run(event.stamp.ns, event.kind, event.data);
  }
}

void SessionWriter::put_edge(const LoopEdge& edge, const char* kind) {
  const PoseBytes motion = encode_pose(edge.T_from_to);
  const CovarianceBytes covariance = encode_covariance(edge.covariance);
  add_edge_.run(edge.from, edge.to, kind, std::span<const std::byte>(motion),
                std::span<const std::byte>(covariance));
}

}  // namespace glint::slam
