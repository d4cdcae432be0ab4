// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

#include "driver/core/error.hpp"
#include "slam/store/database.hpp"

namespace glint::slam {

/// The sentence for a session file that SQLite cannot read: that it is no database, is damaged, or
/// may not be read.
InputError session_damage(const std::filesystem::path& file, const SqlError& error);

/// The sentence for a damaged value: "`what` cannot be read".
InputError session_damage(const std::filesystem::path& file, const std::string& what);

}  // namespace glint::slam
