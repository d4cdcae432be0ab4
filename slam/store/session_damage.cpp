// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_damage.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

namespace glint::slam {
namespace {

constexpr const char* kWayOut =
    "use a copy of it, or make it anew from its capture with `glint replay`";

}  // namespace

InputError session_damage(const std::filesystem::path& file, const SqlError& error) {
  const std::string name = file.string();
  switch (error.code()) {
    case SQLITE_NOTADB:
      return InputError(fmt::format(
          "{} is no Glint session (it is not an SQLite database); name a file that `glint replay` "
          "or glintd wrote",
          name));
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return InputError(
          fmt::format("cannot open {}: {}; check that this user may read it and its directory",
                      name, error.what()));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return InputError(
          fmt::format("{} is held by another program; wait until that has closed it", name));
    default:
      return InputError(fmt::format("{} is damaged ({}); {}", name, error.what(), kWayOut));
  }
}

InputError session_damage(const std::filesystem::path& file, const std::string& what) {
  return InputError(
      fmt::format("{} is damaged ({} cannot be read); {}", file.string(), what, kWayOut));
}

}  // namespace glint::slam
