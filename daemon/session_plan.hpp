// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

#include "daemon/config.hpp"
#include "slam/backend.hpp"

namespace glint::daemon {

/// Which map a run begins with, and where its session goes. Value type.
struct SessionPlan {
  std::filesystem::path file;     ///< Where the session is kept; empty: nowhere.
  std::filesystem::path earlier;  ///< Whose map is gone on with, also `file` itself; empty: none.
  /// For a session of its own, when the sensor is nowhere in that map for `search_s`.
  std::filesystem::path otherwise;
  double search_s = 60.0;
  /// With kLocalize `earlier` is only read, and there is neither `file` nor `otherwise`.
  slam::MapUse use = slam::MapUse::kExtend;
};

/// What map.on_start asks for. continue: of the sessions in state.directory the latest that can be
/// read and has keyframes; those that cannot are logged, and left as they are. @throws ConfigError
/// as new_session_file(), and when the map that localize: names is not there.
SessionPlan plan_session(const Config& config);

/// A session of its own, with an empty map. @throws ConfigError as new_session_file().
SessionPlan plan_session_anew(const Config& config);

/// A session that goes on with the map of `earlier`, which is left as it is.
SessionPlan plan_extension(const Config& config, const std::filesystem::path& earlier);

/// A map that is only read; nothing is kept.
SessionPlan plan_localization(const Config& config, const std::filesystem::path& map);

}  // namespace glint::daemon
