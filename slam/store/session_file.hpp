// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/store/database.hpp"

namespace glint::slam {

/// How closely a session is looked at before it is used.
enum class SessionCheck {
  kVersion,    ///< What it is; at once.
  kStructure,  ///< And all its pages; about a second per gigabyte.
};

/// Opens a session for reading: one that is complete, one that another program is writing now, and
/// one whose writer was killed. Nothing is written, neither in it nor beside it; an older version
/// is migrated in a private copy. @throws InputError in one sentence that names the file, what is
/// wrong with it and what to do.
Database open_session(const std::filesystem::path& file,
                      SessionCheck check = SessionCheck::kStructure);

/// The version of a session whose pages are all sound; writes nothing either. @throws as
/// open_session().
std::int64_t check_session(const std::filesystem::path& file);

}  // namespace glint::slam
