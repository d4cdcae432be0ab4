// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_copy.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <memory>
#include <system_error>

#include "driver/core/crc64.hpp"
#include "driver/core/error.hpp"
#include "driver/core/time.hpp"
#include "slam/store/mapped_file.hpp"
#include "slam/store/session_file.hpp"
#include "slam/store/sync.hpp"
#include "slam/store/temporary_file.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

// Pages of 4 KiB between two calls of the progress: some milliseconds.
constexpr int kPagesAStep = 1024;
// 32 MiB. Left to the end, a slow disk would hold up the session's own writes for minutes, and who
// wants to give the copy up.
constexpr int kStepsASync = 8;

InputError unwritable(const fs::path& target, const std::string& why) {
  return InputError(
      fmt::format("cannot write {}: {}; choose a directory that exists, is writable and has room",
                  target.string(), why));
}

/// False when it was given up.
bool copy_pages(const Database& source, const Database& target, const fs::path& file,
                const CopyProgress& progress) {
  std::unique_ptr<sqlite3_backup, decltype(&sqlite3_backup_finish)> backup(
      sqlite3_backup_init(target.handle(), "main", source.handle(), "main"),
      &sqlite3_backup_finish);
  if (!backup) throw SqlError(target.handle());
  bool wanted = true;
  int result = SQLITE_OK;
  for (int step = 1; result == SQLITE_OK && wanted; ++step) {
    result = sqlite3_backup_step(backup.get(), kPagesAStep);
    // Its closing lets SQLite's lock on the file go, but nobody else knows the file.
    if (step % kStepsASync == 0) sync_file(file);
    const double pages = sqlite3_backup_pagecount(backup.get());
    const double left = sqlite3_backup_remaining(backup.get());
    if (progress) wanted = progress(pages > 0.0 ? 1.0 - left / pages : 1.0);
  }
  if (sqlite3_backup_finish(backup.release()) != SQLITE_OK) throw SqlError(target.handle());
  return wanted || result == SQLITE_DONE;
}

/// False when it was given up.
bool write_copy(Database& source, const fs::path& file, const CopyProgress& progress) {
  // Kept while pages are copied, so that what is written to the source meanwhile changes none.
  source.run("BEGIN; SELECT count(*) FROM sqlite_schema;");
  // It has no name yet, so that nothing need be undone or made to last before it is whole.
  Database target(file.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  target.run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
  if (!copy_pages(source, target, file, progress)) return false;
  // Other programs that read a database with a log leave files beside it.
  target.run("PRAGMA journal_mode = DELETE");
  return true;
}

// Reads it back as the disk will give it, without room for all of it in memory.
void measure(const fs::path& file, SessionCopy& copy) {
  const MappedFile mapped(file);
  copy.bytes = mapped.bytes().size();
  copy.checksum = crc64(mapped.bytes());
}

}  // namespace

std::optional<SessionCopy> copy_session(const fs::path& source, const fs::path& target, Clock clock,
                                        const CopyProgress& progress) {
  const std::int64_t start_ns = clock.monotonic_ns();
  Database session = open_session(source);
  SessionCopy copy;
  copy.file = target;
  try {
    const TemporaryFile temporary(target);
    if (!write_copy(session, temporary.path(), progress)) return std::nullopt;
    measure(temporary.path(), copy);
    temporary.keep();
  } catch (const SqlError& error) {
    throw unwritable(target, error.what());
  } catch (const fs::filesystem_error& error) {
    throw unwritable(target, error.code().message());
  }
  copy.seconds = static_cast<double>(clock.monotonic_ns() - start_ns) * kSecondsPerNs;
  return copy;
}

}  // namespace glint::slam
