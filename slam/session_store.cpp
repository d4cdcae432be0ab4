// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/session_store.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

namespace glint::slam {
namespace {

constexpr const char* kSchema = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE keyframes (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  frame_id INTEGER NOT NULL,
  segment INTEGER NOT NULL,
  T_odom_sensor BLOB NOT NULL,
  T_map_sensor BLOB NOT NULL,
  points BLOB NOT NULL);
CREATE TABLE edges (
  id INTEGER PRIMARY KEY,
  from_keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  to_keyframe INTEGER NOT NULL REFERENCES keyframes(id),
  kind TEXT NOT NULL,
  T_from_to BLOB NOT NULL,
  covariance BLOB NOT NULL);
CREATE TABLE events (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  kind TEXT NOT NULL,
  data TEXT NOT NULL);
)sql";

struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

// x y z (m), qx qy qz qw: seven little-endian doubles.
std::array<double, 7> pose_values(const Pose& pose) {
  const auto& t = pose.translation_m;
  const auto& q = pose.rotation;
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

// Seven bytes a point: int16 x, y, z in centimetres and the intensity as a byte.
std::vector<std::uint8_t> packed_points(const std::vector<MapPoint>& points) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(points.size() * 7);
  for (const MapPoint& p : points) {
    std::array<std::int16_t, 3> cm{};
    bool fits = true;
    for (const auto& [i, value_m] : {std::pair{0U, p.x_m}, {1U, p.y_m}, {2U, p.z_m}}) {
      const float value_cm = std::round(value_m * 100.0F);
      fits = fits && std::abs(value_cm) <= float{std::numeric_limits<std::int16_t>::max()};
      cm[i] = fits ? static_cast<std::int16_t>(value_cm) : std::int16_t{0};
    }
    if (!fits) continue;
    const std::size_t at = bytes.size();
    bytes.resize(at + 7);
    std::memcpy(&bytes[at], cm.data(), 6);
    bytes[at + 6] = static_cast<std::uint8_t>(std::clamp(p.intensity, 0.0F, 255.0F));
  }
  return bytes;
}

}  // namespace

struct SessionStore::Impl {
  ~Impl() {
    add_keyframe.reset();
    add_edge.reset();
    remove_loop.reset();
    insert_event.reset();
    sqlite3_close(db);
  }

  bool run(const char* sql) {
    const bool done = sqlite3_exec(db, sql, nullptr, nullptr, nullptr) == SQLITE_OK;
    if (!done) error = sqlite3_errmsg(db);
    return done;
  }

  Statement prepare(const char* sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(db, sql, -1, &statement, nullptr) != SQLITE_OK) {
      error = sqlite3_errmsg(db);
    }
    return Statement(statement);
  }

  // Runs a statement whose parameters are bound, and makes it ready for the next time.
  bool step(const Statement& statement) {
    const bool done = sqlite3_step(statement.get()) == SQLITE_DONE;
    if (!done) error = sqlite3_errmsg(db);
    sqlite3_reset(statement.get());
    return done;
  }

  /// Ends a transaction that `done` says went well so far.
  bool end(bool done) {
    if (done && run("COMMIT")) return true;
    // The reason why is kept.
    if (sqlite3_get_autocommit(db) == 0) sqlite3_exec(db, "ROLLBACK", nullptr, nullptr, nullptr);
    return false;
  }

  bool insert(const Keyframe& keyframe, const Pose& T_map_sensor);
  bool insert_odometry_edge(const Keyframe& keyframe);
  bool insert_edge(const LoopEdge& edge, const char* kind);
  bool remove(const LoopEdge& loop);
  bool insert(const SessionEvent& event);
  bool move_keyframes(const std::vector<std::pair<std::uint64_t, Pose>>& poses);
  bool put_meta(const char* key, std::string_view value);

  sqlite3* db = nullptr;
  Statement add_keyframe;
  Statement add_edge;
  Statement remove_loop;
  Statement insert_event;
  std::optional<std::pair<std::uint64_t, OdometryEstimate>> last;
  std::string error;
};

bool SessionStore::Impl::insert(const Keyframe& keyframe, const Pose& T_map_sensor) {
  const auto odom = pose_values(keyframe.estimate.T_odom_sensor);
  const auto map = pose_values(T_map_sensor);
  const auto points = packed_points(keyframe.points);
  sqlite3_stmt* s = add_keyframe.get();
  sqlite3_bind_int64(s, 1, static_cast<sqlite3_int64>(keyframe.id));
  sqlite3_bind_int64(s, 2, keyframe.estimate.stamp.ns);
  sqlite3_bind_int64(s, 3, keyframe.estimate.frame_id);
  sqlite3_bind_int64(s, 4, keyframe.estimate.segment);
  sqlite3_bind_blob(s, 5, odom.data(), sizeof odom, SQLITE_TRANSIENT);
  sqlite3_bind_blob(s, 6, map.data(), sizeof map, SQLITE_TRANSIENT);
  sqlite3_bind_blob64(s, 7, points.data(), points.size(), SQLITE_TRANSIENT);
  return step(add_keyframe);
}

bool SessionStore::Impl::insert_odometry_edge(const Keyframe& keyframe) {
  if (!last || last->second.segment != keyframe.estimate.segment) return true;
  const Pose& T_odom_from = last->second.T_odom_sensor;
  return insert_edge(
      {last->first, keyframe.id, T_odom_from.inverse() * keyframe.estimate.T_odom_sensor,
       keyframe.edge_covariance},
      "odometry");
}

bool SessionStore::Impl::insert_edge(const LoopEdge& edge, const char* kind) {
  const auto motion = pose_values(edge.T_from_to);
  sqlite3_stmt* s = add_edge.get();
  sqlite3_bind_int64(s, 1, static_cast<sqlite3_int64>(edge.from));
  sqlite3_bind_int64(s, 2, static_cast<sqlite3_int64>(edge.to));
  sqlite3_bind_text(s, 3, kind, -1, SQLITE_STATIC);
  sqlite3_bind_blob(s, 4, motion.data(), sizeof motion, SQLITE_TRANSIENT);
  sqlite3_bind_blob(s, 5, edge.covariance.data(), 36 * sizeof(double), SQLITE_TRANSIENT);
  return step(add_edge);
}

bool SessionStore::Impl::remove(const LoopEdge& loop) {
  sqlite3_stmt* s = remove_loop.get();
  sqlite3_bind_int64(s, 1, static_cast<sqlite3_int64>(loop.from));
  sqlite3_bind_int64(s, 2, static_cast<sqlite3_int64>(loop.to));
  return step(remove_loop);
}

bool SessionStore::Impl::insert(const SessionEvent& event) {
  sqlite3_stmt* s = insert_event.get();
  sqlite3_bind_int64(s, 1, event.stamp.ns);
  sqlite3_bind_text(s, 2, event.kind.data(), static_cast<int>(event.kind.size()), SQLITE_TRANSIENT);
  sqlite3_bind_text(s, 3, event.data.data(), static_cast<int>(event.data.size()), SQLITE_TRANSIENT);
  return step(insert_event);
}

// Written over in place: an UPDATE would read and write each keyframe's points again.
bool SessionStore::Impl::move_keyframes(const std::vector<std::pair<std::uint64_t, Pose>>& poses) {
  sqlite3_blob* blob = nullptr;
  bool done = true;
  for (const auto& [id, T_map_sensor] : poses) {
    const auto row = static_cast<sqlite3_int64>(id);
    const auto values = pose_values(T_map_sensor);
    const int opened =
        blob == nullptr ? sqlite3_blob_open(db, "main", "keyframes", "T_map_sensor", row, 1, &blob)
                        : sqlite3_blob_reopen(blob, row);
    done = opened == SQLITE_OK &&
           sqlite3_blob_write(blob, values.data(), sizeof values, 0) == SQLITE_OK;
    if (!done) break;
  }
  if (!done) error = sqlite3_errmsg(db);
  sqlite3_blob_close(blob);
  return done;
}

bool SessionStore::Impl::put_meta(const char* key, std::string_view value) {
  const Statement s = prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)");
  if (!s) return false;
  sqlite3_bind_text(s.get(), 1, key, -1, SQLITE_STATIC);
  sqlite3_bind_text(s.get(), 2, value.data(), static_cast<int>(value.size()), SQLITE_STATIC);
  return step(s);
}

SessionStore::SessionStore(const std::filesystem::path& file, const SlamConfig& config)
    : impl_(std::make_unique<Impl>()) {
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm"}) {
    std::filesystem::remove(file.string() + suffix, ignored);
  }
  Impl& my = *impl_;
  const bool opened = sqlite3_open(file.c_str(), &my.db) == SQLITE_OK;
  if (!opened) my.error = sqlite3_errmsg(my.db);
  const bool ready =
      opened && my.run("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;") && my.run("BEGIN") &&
      my.run(kSchema) && my.put_meta("schema_version", "1") &&
      my.put_meta("preset", config.preset) &&
      my.put_meta("pose_format", "x y z (m) qx qy qz qw, little-endian float64") &&
      my.put_meta("points_format", "int16 x y z (cm), uint8 intensity, sensor frame at t_ns") &&
      my.run("COMMIT");
  if (ready) {
    my.add_keyframe = my.prepare("INSERT INTO keyframes VALUES (?, ?, ?, ?, ?, ?, ?)");
    my.add_edge = my.prepare(
        "INSERT INTO edges (from_keyframe, to_keyframe, kind, T_from_to, covariance) "
        "VALUES (?, ?, ?, ?, ?)");
    my.remove_loop = my.prepare(
        "DELETE FROM edges WHERE kind = 'loop' AND from_keyframe = ? AND to_keyframe = ?");
    my.insert_event = my.prepare("INSERT INTO events (t_ns, kind, data) VALUES (?, ?, ?)");
  }
  if (!my.add_keyframe || !my.add_edge || !my.remove_loop || !my.insert_event) {
    throw InputError(fmt::format(
        "cannot create the session file {}: {}; choose a directory that exists and is writable",
        file.string(), my.error));
  }
}

SessionStore::~SessionStore() = default;

bool SessionStore::set_sensor(const SensorInfo& info) {
  return impl_->put_meta("sensor", to_metadata_json(info));
}

bool SessionStore::add(const Keyframe& keyframe, const Pose& T_map_sensor) {
  Impl& my = *impl_;
  const bool done = my.end(my.run("BEGIN") && my.insert(keyframe, T_map_sensor) &&
                           my.insert_odometry_edge(keyframe));
  if (done) my.last = {keyframe.id, keyframe.estimate};
  return done;
}

bool SessionStore::apply(const LoopChanges& changes) {
  Impl& my = *impl_;
  bool done = my.run("BEGIN");
  for (const LoopEdge& loop : changes.added) done = done && my.insert_edge(loop, "loop");
  for (const LoopEdge& loop : changes.removed) done = done && my.remove(loop);
  for (const SessionEvent& event : changes.events) done = done && my.insert(event);
  return my.end(done && my.move_keyframes(changes.poses));
}

std::string_view SessionStore::error() const { return impl_->error; }

}  // namespace glint::slam
