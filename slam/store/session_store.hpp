// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "driver/core/clock.hpp"
#include "driver/core/sensor_info.hpp"
#include "slam/keyframe.hpp"
#include "slam/loops/vocabulary.hpp"
#include "slam/store/database.hpp"
#include "slam/store/loop_changes.hpp"
#include "slam/store/session_record.hpp"
#include "slam/store/session_writer.hpp"

namespace glint::slam {

struct SessionStoreOptions {
  /// Goes on with a session that is there, after migrating it. Else a file that is there is
  /// replaced.
  bool continues = false;
  Clock clock = {};
  /// What was added is on the disk this much later, and the time of one write.
  std::int64_t commit_interval_ns = 400'000'000;
  /// While the disk takes nothing so much waits in memory; keyframes beyond are lost, and counted.
  std::size_t most_waiting_bytes = 64 << 20;
};

/// The session file: one SQLite database that holds what the back end tells it, some keyframes to a
/// transaction. After a kill, or a power cut, it holds all that was committed. Tables:
/// session_schema.hpp. Thread-compatible; owned by the back end, whose thread waits for the disk,
/// so that no other does.
class SessionStore {
 public:
  /// @throws InputError naming the file if it cannot be made, or continued.
  explicit SessionStore(const std::filesystem::path& file, const SessionStoreOptions& options = {});
  /// Commits what it can.
  ~SessionStore();
  SessionStore(const SessionStore&) = delete;
  SessionStore& operator=(const SessionStore&) = delete;

  /// A line of the table `meta`.
  void set_meta(std::string key, std::string value);
  /// Whose scans the keyframes that follow are of.
  void set_sensor(const SensorInfo& info);
  /// A keyframe, and the odometry edge to the one before it of the same segment. `words`: what it
  /// looks like, by the vocabulary whose hash the session has; null where that is not known.
  void add(const Keyframe& keyframe, const Pose& T_map_sensor,
           const std::optional<BagOfWords>& words = {});
  void apply(const LoopChanges& changes);

  /// Writes all that waits and returns when it is on the disk. False when it could not be written
  /// (disk full); error() says why, and it goes on waiting.
  bool commit();
  /// The same once commit_interval_ns have passed since the last time. To be called often.
  bool commit_if_due();

  /// Commits that failed and keyframes that were refused, since the beginning.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  /// Why the last one did.
  [[nodiscard]] std::string_view error() const { return error_; }
  /// Keyframes that were refused, and those that wait although a commit was tried.
  [[nodiscard]] std::uint64_t missing_keyframes() const;

 private:
  void take(SessionRecord record);
  void write_waiting();
  void fail(std::string_view why);

  const SessionStoreOptions options_;
  Database database_;
  SessionWriter writer_;
  std::deque<SessionRecord> waiting_;
  std::map<std::uint64_t, Pose> moved_;  ///< T_map_sensor that keyframes are to have; waits, too.
  std::size_t waiting_bytes_ = 0;
  std::optional<std::pair<std::uint64_t, OdometryEstimate>> last_;  ///< Keyframe.
  std::uint64_t next_keyframe_ = 0;
  std::int64_t last_commit_ns_ = 0;
  bool stuck_ = false;  ///< The last commit failed.
  std::uint64_t refused_ = 0;
  std::uint64_t failures_ = 0;
  std::string error_;
};

}  // namespace glint::slam
