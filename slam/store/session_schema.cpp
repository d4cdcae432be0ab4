// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_schema.hpp"

#include <fmt/format.h>

#include "driver/core/error.hpp"
#include "slam/store/old_points.hpp"
#include "slam/store/point_codec.hpp"
#include "slam/store/session_damage.hpp"
#include "slam/store/statement.hpp"

namespace glint::slam {
namespace {

// Points and keypoints have tables of their own: poses can be read, and moved, without them.
constexpr const char* kPayloadTables = R"sql(
CREATE TABLE sensors (first_keyframe INTEGER PRIMARY KEY, metadata TEXT NOT NULL);
CREATE TABLE clouds (
  keyframe INTEGER PRIMARY KEY REFERENCES keyframes(id),
  points BLOB NOT NULL);
CREATE TABLE features (
  keyframe INTEGER PRIMARY KEY REFERENCES keyframes(id),
  data BLOB NOT NULL);
CREATE INDEX edges_to ON edges(to_keyframe);
CREATE VIEW segments AS
  SELECT segment AS id, count(*) AS keyframes, min(id) AS first_keyframe, max(id) AS last_keyframe,
    min(t_ns) AS first_t_ns, max(t_ns) AS last_t_ns
  FROM keyframes GROUP BY segment;
)sql";

// What keyframes look like: enough to know where to look for a place, so that a large map need not
// be read for it. Sessions from before it lack the table, and one may lack a keyframe's words.
constexpr const char* kWordsTable = R"sql(
CREATE TABLE IF NOT EXISTS words (
  keyframe INTEGER PRIMARY KEY REFERENCES keyframes(id),
  data BLOB NOT NULL);
)sql";

constexpr const char* kTables = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE keyframes (
  id INTEGER PRIMARY KEY,
  t_ns INTEGER NOT NULL,
  frame_id INTEGER NOT NULL,
  segment INTEGER NOT NULL,
  T_odom_sensor BLOB NOT NULL,
  T_map_sensor BLOB NOT NULL,
  sequence INTEGER NOT NULL,
  state TEXT NOT NULL,
  completeness REAL NOT NULL,
  covariance BLOB,
  gravity BLOB);
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

// Version 1 did not tell a scan's number from the one on the wire, which counts them too.
constexpr const char* kColumnsOf2 = R"sql(
ALTER TABLE keyframes ADD COLUMN sequence INTEGER NOT NULL DEFAULT 0;
ALTER TABLE keyframes ADD COLUMN state TEXT NOT NULL DEFAULT 'TRACKING';
ALTER TABLE keyframes ADD COLUMN completeness REAL NOT NULL DEFAULT 1.0;
ALTER TABLE keyframes ADD COLUMN covariance BLOB;
ALTER TABLE keyframes ADD COLUMN gravity BLOB;
UPDATE keyframes SET sequence = frame_id;
INSERT INTO sensors SELECT 0, value FROM meta WHERE key = 'sensor';
DELETE FROM meta WHERE key IN ('schema_version', 'sensor', 'points_format');
)sql";

void put_formats(Database& database) {
  Statement put(database, "INSERT OR REPLACE INTO meta VALUES (?, ?)");
  put.run("pose_format", "x y z (m) qx qy qz qw, little-endian float64");
  put.run("covariance_format",
          "x y z rx ry rz by rows, right perturbation, m^2 and rad^2, little-endian float64");
  put.run("points_format",
          fmt::format("zstd of: byte 1, uint32 count, then x, y, z as differences in {} m, zigzag, "
                      "varint, then intensities as bytes; sensor frame at t_ns",
                      kPointQuantum_m));
  put.run("features_format",
          "zstd of: byte 1, uint32 count, then descriptors (32 bytes), points (3 float32, sensor "
          "frame, m), u px, v px, angle rad, response (float32), octave (byte)");
  put.run("words_format", "of the vocabulary, by word: uint32 word, float32 weight; little-endian");
}

void sign(Database& database) {
  database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {};",
                           kSessionApplicationId, kSessionVersion));
}

void move_points_of_1(Database& database) {
  Statement read(database, "SELECT id, points FROM keyframes ORDER BY id");
  Statement write(database, "INSERT INTO clouds VALUES (?, ?)");
  while (read.next()) {
    const std::vector<std::byte> points = encode_points(points_of_version_1(read.bytes(1)));
    write.run(read.integer(0), std::span<const std::byte>(points));
  }
}

bool is_version_1(const Database& database) {
  return database.number(
             "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN "
             "('meta', 'keyframes', 'edges', 'events')") == 4 &&
         database.text("SELECT value FROM meta WHERE key = 'schema_version'") == "1";
}

InputError foreign(const std::filesystem::path& file) {
  return InputError(
      fmt::format("{} is no Glint session, but {}; name a file that `glint replay` or glintd wrote",
                  file.string(),
                  std::filesystem::file_size(file) == 0 ? "empty" : "another program's database"));
}

}  // namespace

void create_session_tables(Database& database) {
  database.run(kTables);
  database.run(kPayloadTables);
  database.run(kWordsTable);
  put_formats(database);
  sign(database);
}

std::int64_t session_version(const Database& database, const std::filesystem::path& file) {
  try {
    const std::int64_t application = database.number("PRAGMA application_id");
    const std::int64_t version = database.number("PRAGMA user_version");
    if (application == 0 && version == 0 && is_version_1(database)) return 1;
    if (application != kSessionApplicationId || version < 1) throw foreign(file);
    if (version <= kSessionVersion) return version;
    throw InputError(
        fmt::format("{} was written by a newer Glint (its format is {}, this one reads up to {}); "
                    "update Glint to use it",
                    file.string(), version, kSessionVersion));
  } catch (const SqlError& error) {
    throw session_damage(file, error);
  }
}

void migrate_session(Database& database, std::int64_t version) {
  database.run(kWordsTable);
  if (version == kSessionVersion) return;
  Transaction transaction(database);
  database.run(kPayloadTables);
  database.run(kColumnsOf2);
  move_points_of_1(database);
  database.run("ALTER TABLE keyframes DROP COLUMN points");
  put_formats(database);
  sign(database);
  transaction.commit();
}

}  // namespace glint::slam
