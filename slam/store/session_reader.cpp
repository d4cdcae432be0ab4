// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_reader.hpp"

#include <fmt/format.h>

#include <utility>

#include "slam/store/feature_codec.hpp"
#include "slam/store/point_codec.hpp"
#include "slam/store/session_damage.hpp"
#include "slam/store/statement.hpp"
#include "slam/store/value_codec.hpp"
#include "slam/store/words_codec.hpp"

namespace glint::slam {
namespace {

// The odometry edge to a keyframe comes with it.
constexpr const char* kOutline =
    "SELECT k.id, t_ns, frame_id, segment, T_odom_sensor, T_map_sensor, sequence, state, "
    "completeness, k.covariance, gravity, e.covariance";
constexpr const char* kFromKeyframes =
    " FROM keyframes k LEFT JOIN edges e ON e.to_keyframe = k.id AND e.kind = 'odometry' ";
constexpr const char* kPayload =
    "LEFT JOIN clouds ON clouds.keyframe = k.id LEFT JOIN features ON features.keyframe = k.id ";

std::string all_of_keyframes() {
  return fmt::format("{}, points, data{}{}", kOutline, kFromKeyframes, kPayload);
}

std::string name_of(std::uint64_t keyframe, const char* part) {
  return fmt::format("{} of keyframe {}", part, keyframe);
}

std::uint64_t id_at(const Statement& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

}  // namespace

SessionReader::SessionReader(std::filesystem::path file, SessionCheck check)
    : file_(std::move(file)), database_(open_session(file_, check)) {
  try {
    // What is written meanwhile is not seen; an edge has both its keyframes.
    database_.run("BEGIN");
  } catch (const SqlError& error) {
    throw session_damage(file_, error);
  }
}

template <class Visit, class... Values>
void SessionReader::query(const std::string& sql, Visit visit, const Values&... values) const {
  try {
    Statement statement(database_, sql);
    statement.bind_all(values...);
    while (statement.next()) visit(std::as_const(statement));
  } catch (const SqlError& error) {
    throw session_damage(file_, error);
  }
}

template <class Value>
Value SessionReader::sound(std::optional<Value> value, const std::string& what) const {
  if (!value) throw session_damage(file_, what);
  return *std::move(value);
}

std::string SessionReader::meta(std::string_view key) const {
  std::string value;
  query(
      "SELECT value FROM meta WHERE key = ?", [&](const Statement& row) { value = row.text(0); },
      key);
  return value;
}

std::vector<SessionSensor> SessionReader::sensors() const {
  std::vector<SessionSensor> sensors;
  query("SELECT first_keyframe, metadata FROM sensors ORDER BY first_keyframe",
        [&](const Statement& row) {
          sensors.push_back({id_at(row, 0), parse_sensor_info(row.text(1), file_.string())});
        });
  return sensors;
}

std::size_t SessionReader::keyframe_count() const {
  std::size_t count = 0;
  query("SELECT count(*) FROM keyframes", [&](const Statement& row) { count = id_at(row, 0); });
  return count;
}

std::vector<KeyframePose> SessionReader::poses() const {
  std::vector<KeyframePose> poses;
  query("SELECT id, segment, t_ns, T_odom_sensor, T_map_sensor FROM keyframes ORDER BY id",
        [&](const Statement& row) {
          const std::uint64_t id = id_at(row, 0);
          poses.push_back({id,
                           static_cast<std::uint32_t>(row.integer(1)),
                           {row.integer(2)},
                           sound(decode_pose(row.bytes(3)), name_of(id, "the pose")),
                           sound(decode_pose(row.bytes(4)), name_of(id, "the pose"))});
        });
  return poses;
}

std::vector<SessionSegment> SessionReader::segments() const {
  std::vector<SessionSegment> segments;
  query(
      "SELECT id, keyframes, first_keyframe, last_keyframe, first_t_ns, last_t_ns FROM segments "
      "ORDER BY id",
      [&](const Statement& row) {
        segments.push_back({static_cast<std::uint32_t>(row.integer(0)),
                            id_at(row, 1),
                            id_at(row, 2),
                            id_at(row, 3),
                            {row.integer(4)},
                            {row.integer(5)}});
      });
  return segments;
}

std::vector<LoopEdge> SessionReader::edges(const char* kind) const {
  std::vector<LoopEdge> edges;
  query(
      "SELECT from_keyframe, to_keyframe, T_from_to, covariance FROM edges WHERE kind = ? "
      "ORDER BY id",
      [&](const Statement& row) {
        const std::string what =
            fmt::format("the edge from {} to {}", id_at(row, 0), id_at(row, 1));
        edges.push_back({id_at(row, 0), id_at(row, 1), sound(decode_pose(row.bytes(2)), what),
                         sound(decode_covariance(row.bytes(3)), what)});
      },
      std::string_view(kind));
  return edges;
}

std::vector<SessionEvent> SessionReader::events() const {
  std::vector<SessionEvent> events;
  query("SELECT t_ns, kind, data FROM events ORDER BY id", [&](const Statement& row) {
    events.push_back({{row.integer(0)}, std::string(row.text(1)), std::string(row.text(2))});
  });
  return events;
}

void SessionReader::for_each_keyframe(const std::function<void(SessionKeyframe&&)>& take) const {
  query(all_of_keyframes() + "ORDER BY k.id",
        [&](const Statement& row) { take(keyframe_of(row)); });
}

void SessionReader::for_some_keyframes(std::uint64_t first, std::size_t most,
                                       const std::function<void(SessionKeyframe&&)>& take) const {
  query(
      all_of_keyframes() + "WHERE k.id >= ? ORDER BY k.id LIMIT ?",
      [&](const Statement& row) { take(keyframe_of(row)); }, first, most);
}

bool SessionReader::has_words() const {
  bool there = false;
  query("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = 'words'",
        [&](const Statement& row) { there = row.integer(0) > 0; });
  return there;
}

void SessionReader::for_each_outline(const std::function<void(KeyframeOutline&&)>& take) const {
  const std::string sql =
      has_words() ? fmt::format("{}, w.data{}LEFT JOIN words w ON w.keyframe = k.id ORDER BY k.id",
                                kOutline, kFromKeyframes)
                  : fmt::format("{}, NULL{}ORDER BY k.id", kOutline, kFromKeyframes);
  query(sql, [&](const Statement& row) {
    KeyframeOutline outline;
    read_outline(row, outline.keyframe, outline.T_map_sensor);
    if (!row.is_null(12)) {
      outline.words = sound(decode_words(row.bytes(12)), name_of(outline.keyframe.id, "the words"));
    }
    take(std::move(outline));
  });
}

std::optional<SessionKeyframe> SessionReader::keyframe(std::uint64_t id) const {
  std::optional<SessionKeyframe> keyframe;
  query(
      all_of_keyframes() + "WHERE k.id = ?",
      [&](const Statement& row) { keyframe = keyframe_of(row); }, id);
  return keyframe;
}

void SessionReader::read_outline(const Statement& row, Keyframe& keyframe,
                                 Pose& T_map_sensor) const {
  const std::uint64_t id = keyframe.id = id_at(row, 0);
  OdometryEstimate& estimate = keyframe.estimate;
  estimate.stamp.ns = row.integer(1);
  estimate.frame_id = static_cast<std::uint32_t>(row.integer(2));
  estimate.segment = static_cast<std::uint32_t>(row.integer(3));
  estimate.T_odom_sensor = sound(decode_pose(row.bytes(4)), name_of(id, "the pose"));
  T_map_sensor = sound(decode_pose(row.bytes(5)), name_of(id, "the pose"));
  estimate.sequence = id_at(row, 6);
  estimate.state = sound(tracking_state_from(row.text(7)), name_of(id, "the state"));
  estimate.completeness = row.real(8);
  const auto covariance_at = [&](int column) {
    return sound(decode_covariance(row.bytes(column)), name_of(id, "the covariance"));
  };
  if (!row.is_null(9)) estimate.covariance = covariance_at(9);
  if (!row.is_null(10)) {
    keyframe.gravity = sound(decode_gravity(row.bytes(10)), name_of(id, "gravity"));
  }
  if (!row.is_null(11)) keyframe.edge_covariance = covariance_at(11);
}

SessionKeyframe SessionReader::keyframe_of(const Statement& row) const {
  SessionKeyframe out;
  read_outline(row, out.keyframe, out.T_map_sensor);
  const std::uint64_t id = out.keyframe.id;
  out.keyframe.points = sound(decode_points(row.bytes(12)), name_of(id, "the points"));
  // Version 1 kept none.
  if (!row.is_null(13)) {
    out.keyframe.features = sound(decode_features(row.bytes(13)), name_of(id, "the keypoints"));
  }
  return out;
}

}  // namespace glint::slam
