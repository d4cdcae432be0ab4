// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_file.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <fstream>
#include <string>

#include "slam/store/session_damage.hpp"
#include "slam/store/session_schema.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

bool has_bytes(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return !error && size > 0;
}

fs::path log_of(const fs::path& file) { return file.string() + "-wal"; }

// A log that was only begun, or not even that, before its writer was killed has nothing to tell,
// and SQLite waits in vain for it to become one where it may not write.
bool has_log(const fs::path& file) {
  constexpr std::size_t kLogHeaderBytes = 32;
  std::array<unsigned char, kLogHeaderBytes + 1> start{};
  std::ifstream in(log_of(file), std::ios::binary);
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  // 0x377F0682 or 0x377F0683 by its byte order.
  return in.good() && start[0] == 0x37 && start[1] == 0x7F && start[2] == 0x06 &&
         (start[3] | 1U) == 0x83;
}

Database open_read_only(const fs::path& file, const std::string& parameters) {
  Database database(file_uri(file, "mode=ro&" + parameters), SQLITE_OPEN_READONLY);
  // The last one to close a database would take its log in.
  sqlite3_db_config(database.handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  return database;
}

// SQLite makes no file beside a database that it takes for immutable, but then it does not see what
// a log has that the database lacks. With the log's index it reads both, and minds the locks of one
// who may be writing. Without that index nobody is writing, so that no lock is needed to read the
// log, and the index can stay in memory.
Database open_untouched(const fs::path& file) {
  if (!has_log(file)) return open_read_only(file, "immutable=1");
  if (has_bytes(file.string() + "-shm")) return open_read_only(file, "readonly_shm=1");
  Database database = open_read_only(file, "vfs=unix-none");
  database.run("PRAGMA locking_mode = EXCLUSIVE");
  return database;
}

// A last page of which a part is missing is full of zeros to SQLite. While there is a log, that may
// hold the rest.
bool ends_in_a_page(const Database& database, const fs::path& file) {
  return has_log(file) ||
         static_cast<std::int64_t>(fs::file_size(file)) % database.number("PRAGMA page_size") == 0;
}

void check_structure(const Database& database, const fs::path& file) {
  if (!ends_in_a_page(database, file)) throw session_damage(file, "the last page");
  const std::string found = database.text("PRAGMA quick_check(1)");
  if (found != "ok") throw session_damage(file, SqlError(SQLITE_CORRUPT, found));
}

std::int64_t checked_version(const Database& database, const fs::path& file, SessionCheck check) {
  const std::int64_t version = session_version(database, file);
  if (check == SessionCheck::kStructure) check_structure(database, file);
  return version;
}

Database private_copy(const Database& source) {
  Database copy("", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  sqlite3_backup* backup = sqlite3_backup_init(copy.handle(), "main", source.handle(), "main");
  if (backup == nullptr) throw SqlError(copy.handle());
  sqlite3_backup_step(backup, -1);
  if (sqlite3_backup_finish(backup) != SQLITE_OK) throw SqlError(copy.handle());
  return copy;
}

void expect_a_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_regular_file(file, error)) return;
  throw InputError(fmt::format(
      "there is no session file {}; name one that `glint replay` or glintd wrote", file.string()));
}

}  // namespace

Database open_session(const fs::path& file, SessionCheck check) {
  expect_a_file(file);
  try {
    Database database = open_untouched(file);
    const std::int64_t version = checked_version(database, file, check);
    if (version == kSessionVersion) return database;
    Database copy = private_copy(database);
    migrate_session(copy, version);
    return copy;
  } catch (const SqlError& error) {
    throw session_damage(file, error);
  }
}

std::int64_t check_session(const fs::path& file) {
  expect_a_file(file);
  try {
    return checked_version(open_untouched(file), file, SessionCheck::kStructure);
  } catch (const SqlError& error) {
    throw session_damage(file, error);
  }
}

}  // namespace glint::slam
