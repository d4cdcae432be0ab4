// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/running_job.hpp"
#include "daemon/runtime.hpp"
#include "daemon/saved_maps.hpp"

namespace glint::daemon {

/// What is saved, and where. Value type.
struct MapSaving {
  std::filesystem::path session_file;  ///< The one that is being written.
  std::string name;
  SavedMaps maps;
};

/// The job `save_map`: copies the session with every keyframe that the back end has, in place of
/// what had the name. The result: `name bytes checksum seconds`, the checksum as 16 hexadecimal
/// digits of CRC-64/XZ. Null when it was given up; what had the name is still there then, as it is
/// when it failed. For the jobs thread. @throws InputError when the session or the map cannot be
/// written.
std::optional<Json> save_map(const MapSaving& saving, Runtime& runtime, RunningJob& job);

}  // namespace glint::daemon
