// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/store/database.hpp"

namespace glint::slam {

/// "GLNT": says that an SQLite database is a session.
constexpr std::int64_t kSessionApplicationId = 0x474C4E54;
/// Of the tables, SQLite's user_version. 2: what create_session_tables() makes. 1: points in the
/// table `keyframes`, without compression; neither keypoints nor application id.
constexpr std::int64_t kSessionVersion = 2;

/// Makes the tables of an empty database, in the caller's transaction. `meta` (key, value),
/// `sensors` (metadata, and the first keyframe that is theirs), `keyframes` (poses), `clouds`
/// (their points, see point_codec.hpp), `features` (their keypoints, see feature_codec.hpp),
/// `edges` (relative poses between keyframes with their covariance, of kind `odometry` or `loop`),
/// `events`, and the view `segments`. @throws SqlError.
void create_session_tables(Database& database);

/// Which version a session has. @throws InputError that names `file`, what is wrong with it and
/// what to do, when it is another program's, a newer Glint's or damaged.
std::int64_t session_version(const Database& database, const std::filesystem::path& file);

/// Brings an older version's tables to kSessionVersion, all or nothing. @throws SqlError.
void migrate_session(Database& database, std::int64_t version);

}  // namespace glint::slam
