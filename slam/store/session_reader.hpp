// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"
#include "slam/loops/vocabulary.hpp"
#include "slam/store/database.hpp"
#include "slam/store/session_event.hpp"
#include "slam/store/session_file.hpp"

namespace glint::slam {

class Statement;

/// A keyframe as the session has it. Its points are rounded (point_codec.hpp), its features those
/// that feature_codec.hpp keeps; of the estimate velocity, weak axes and counts are not kept.
struct SessionKeyframe {
  Keyframe keyframe;
  Pose T_map_sensor;
};

/// A keyframe without its points and features, and what its image looks like.
struct KeyframeOutline {
  Keyframe keyframe;
  Pose T_map_sensor;
  std::optional<BagOfWords> words;  ///< Null: the session does not say.
};

/// A keyframe without its points and features.
struct KeyframePose {
  std::uint64_t id = 0;
  std::uint32_t segment = 0;
  SensorTime stamp;
  Pose T_odom_sensor;
  Pose T_map_sensor;
};

/// A stretch of keyframes that odometry links.
struct SessionSegment {
  std::uint32_t id = 0;
  std::uint64_t keyframes = 0;
  std::uint64_t first_keyframe = 0;
  std::uint64_t last_keyframe = 0;
  SensorTime first_stamp;
  SensorTime last_stamp;
};

/// A sensor, and the first keyframe that is its own.
struct SessionSensor {
  std::uint64_t first_keyframe = 0;
  SensorInfo info;
};

/// Gives back what a session file holds; never writes to it or beside it. One object sees the
/// session as it was when first asked. Thread-compatible. Every member throws InputError, in one
/// sentence that names the file, where the file is damaged.
class SessionReader {
 public:
  /// @throws InputError as open_session().
  explicit SessionReader(std::filesystem::path file, SessionCheck check = SessionCheck::kStructure);

  /// A value of the table `meta`: "preset", "vocabulary_hash", "map_voxel_m"; empty when it is not
  /// there.
  [[nodiscard]] std::string meta(std::string_view key) const;
  [[nodiscard]] std::vector<SessionSensor> sensors() const;
  [[nodiscard]] std::size_t keyframe_count() const;
  /// In order of their ids.
  [[nodiscard]] std::vector<KeyframePose> poses() const;
  [[nodiscard]] std::vector<SessionSegment> segments() const;
  [[nodiscard]] std::vector<LoopEdge> odometry_edges() const { return edges("odometry"); }
  [[nodiscard]] std::vector<LoopEdge> loop_edges() const { return edges("loop"); }
  [[nodiscard]] std::vector<SessionEvent> events() const;

  /// Calls `take` with each keyframe, in order of their ids; one at a time is in memory.
  void for_each_keyframe(const std::function<void(SessionKeyframe&&)>& take) const;
  /// The same without what takes long to read.
  void for_each_outline(const std::function<void(KeyframeOutline&&)>& take) const;
  /// The first `most` keyframes whose ids are `first` or more, in order.
  void for_some_keyframes(std::uint64_t first, std::size_t most,
                          const std::function<void(SessionKeyframe&&)>& take) const;
  /// Null when there is none of that id.
  [[nodiscard]] std::optional<SessionKeyframe> keyframe(std::uint64_t id) const;

 private:
  [[nodiscard]] std::vector<LoopEdge> edges(const char* kind) const;
  [[nodiscard]] bool has_words() const;
  [[nodiscard]] SessionKeyframe keyframe_of(const Statement& row) const;
  void read_outline(const Statement& row, Keyframe& keyframe, Pose& T_map_sensor) const;
  /// Calls `visit` with each row; what SQLite refuses becomes an InputError.
  template <class Visit, class... Values>
  void query(const std::string& sql, Visit visit, const Values&... values) const;
  /// The value, or the InputError that says that `what` is damaged.
  template <class Value>
  [[nodiscard]] Value sound(std::optional<Value> value, const std::string& what) const;

  std::filesystem::path file_;
  Database database_;
};

}  // namespace glint::slam
