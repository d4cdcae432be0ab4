// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_store.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <system_error>
#include <variant>

#include "slam/store/feature_codec.hpp"
#include "slam/store/point_codec.hpp"
#include "slam/store/session_damage.hpp"
#include "slam/store/session_file.hpp"
#include "slam/store/session_schema.hpp"
#include "slam/store/temporary_file.hpp"
#include "slam/store/words_codec.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

// FULL: a commit has reached the disk when it returns, not only its cache.
constexpr const char* kDurable = "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;";

// With all its tables before it gets its name: whenever it is there, it is a session.
void create(const fs::path& file) {
  const TemporaryFile temporary(file);
  {
    Database database(temporary.path().string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    Transaction transaction(database);
    create_session_tables(database);
    transaction.commit();
  }
  // The log of the one that is replaced would be taken for the new one's.
  std::error_code ignored;
  for (const char* suffix : {"-wal", "-shm"}) fs::remove(file.string() + suffix, ignored);
  temporary.keep();
}

Database open_for_writing(const fs::path& file, std::int64_t version) {
  Database database(file.string(), SQLITE_OPEN_READWRITE);
  database.run(kDurable);
  migrate_session(database, version);
  return database;
}

Database open_new(const fs::path& file) {
  const auto refusal = [&](const std::string& why) {
    return InputError(fmt::format(
        "cannot create the session file {}: {}; choose a directory that exists and is writable",
        file.string(), why));
  };
  try {
    create(file);
    return open_for_writing(file, kSessionVersion);
  } catch (const SqlError& error) {
    throw refusal(error.what());
  } catch (const fs::filesystem_error& error) {
    throw refusal(error.code().message());
  }
}

Database go_on_with(const fs::path& file) {
  // Before anything is written: what is no session, or a damaged one, stays as it is.
  const std::int64_t version = check_session(file);
  try {
    return open_for_writing(file, version);
  } catch (const SqlError& error) {
    throw session_damage(file, error);
  }
}

}  // namespace

SessionStore::SessionStore(const fs::path& file, const SessionStoreOptions& options)
    : options_(options),
      database_(options.continues && fs::exists(file) ? go_on_with(file) : open_new(file)),
      writer_(database_),
      next_keyframe_(static_cast<std::uint64_t>(
          database_.number("SELECT coalesce(max(id) + 1, 0) FROM keyframes"))),
      last_commit_ns_(options.clock.monotonic_ns()) {}

SessionStore::~SessionStore() { commit(); }

void SessionStore::set_meta(std::string key, std::string value) {
  take(MetaRecord{std::move(key), std::move(value)});
}

void SessionStore::set_sensor(const SensorInfo& info) {
  take(SensorRecord{next_keyframe_, to_metadata_json(info)});
}

void SessionStore::add(const Keyframe& keyframe, const Pose& T_map_sensor,
                       const std::optional<BagOfWords>& words) {
  if (waiting_bytes_ > options_.most_waiting_bytes) {
    ++refused_;
    return fail(error_);
  }
  KeyframeRecord record{keyframe.id,
                        keyframe.estimate,
                        T_map_sensor,
                        keyframe.gravity,
                        encode_points(keyframe.points),
                        encode_features(keyframe.features),
                        {},
                        {}};
  if (words) record.words = encode_words(*words);
  if (last_ && last_->second.segment == keyframe.estimate.segment) {
    const Pose& T_odom_from = last_->second.T_odom_sensor;
    record.odometry =
        LoopEdge{last_->first, keyframe.id, T_odom_from.inverse() * keyframe.estimate.T_odom_sensor,
                 keyframe.edge_covariance};
  }
  last_ = {keyframe.id, keyframe.estimate};
  next_keyframe_ = keyframe.id + 1;
  take(std::move(record));
}

void SessionStore::apply(const LoopChanges& changes) {
  for (const auto& [id, T_map_sensor] : changes.poses) moved_[id] = T_map_sensor;
  if (changes.events.empty() && changes.added.empty() && changes.removed.empty()) return;
  take(LoopChanges{changes.events, changes.added, changes.removed, {}});
}

void SessionStore::take(SessionRecord record) {
  waiting_bytes_ += bytes_of(record);
  waiting_.push_back(std::move(record));
}

bool SessionStore::commit_if_due() {
  const std::int64_t since_ns = options_.clock.monotonic_ns() - last_commit_ns_;
  return since_ns < options_.commit_interval_ns || commit();
}

bool SessionStore::commit() {
  last_commit_ns_ = options_.clock.monotonic_ns();
  if (waiting_.empty() && moved_.empty()) return true;
  stuck_ = true;
  try {
    Transaction transaction(database_);
    write_waiting();
    transaction.commit();
  } catch (const SqlError& error) {
    fail(error.what());
    return false;
  }
  stuck_ = false;
  waiting_.clear();
  moved_.clear();
  waiting_bytes_ = 0;
  return true;
}

// In its order: an edge that was added and removed meanwhile is no more.
void SessionStore::write_waiting() {
  for (auto record = waiting_.begin(); record != waiting_.end();) {
    try {
      writer_.write(*record);
      ++record;
    } catch (const SqlError& error) {
      if (error.code() != SQLITE_CONSTRAINT) throw;
      // Its id is taken: it will never be written, and is not to be in the way of all others.
      ++refused_;
      fail(error.what());
      record = waiting_.erase(record);
    }
  }
  for (const auto& [id, T_map_sensor] : moved_) writer_.move(id, T_map_sensor);
}

void SessionStore::fail(std::string_view why) {
  ++failures_;
  error_ = std::string(why);
}

std::uint64_t SessionStore::missing_keyframes() const {
  const auto is_keyframe = [](const SessionRecord& record) {
    return std::holds_alternative<KeyframeRecord>(record);
  };
  if (!stuck_) return refused_;
  return refused_ + static_cast<std::uint64_t>(std::ranges::count_if(waiting_, is_keyframe));
}

}  // namespace glint::slam
