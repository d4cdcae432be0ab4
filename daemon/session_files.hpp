// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "daemon/config.hpp"

namespace glint::daemon {

/// What the names of all sessions end with, and those of glintd's own begin with.
constexpr std::string_view kSessionSuffix = ".glint";
constexpr std::string_view kSessionPrefix = "session-";

/// Where sessions and maps are kept, by state.directory; empty for nowhere.
std::filesystem::path state_directory(const Config& config);

/// The files of a directory that are called as sessions are, in order of their names.
/// @throws InputError when it cannot be listed.
std::vector<std::filesystem::path> session_files(const std::filesystem::path& directory);

/// glintd's own sessions in `directory`, those first that were not written to for longest.
/// @throws InputError as session_files().
std::vector<std::filesystem::path> own_sessions(const std::filesystem::path& directory);

/// Removes a session, and what a writer that was killed left beside it.
void remove_session(const std::filesystem::path& file, std::error_code& error);

/// What there is to say of a session, quick to find out: its pages are not all looked at. Has
/// `error`, a sentence, when it cannot be read; else `bytes keyframes segments loops way_m
/// duration_s saved_ns saved`, the last two when it was last written, by this machine's clock.
Json describe_session(const std::filesystem::path& file);

/// A session that made room.
struct RemovedSession {
  std::filesystem::path file;
  std::uint64_t bytes = 0;
};

/// Removes glintd's own sessions in `directory`, those first that were not written to for longest,
/// until those left take no more than `most_bytes`; never `current`, and nothing in folders. What
/// cannot be removed stays.
std::vector<RemovedSession> remove_old_sessions(const std::filesystem::path& directory,
                                                std::uint64_t most_bytes,
                                                const std::filesystem::path& current);

}  // namespace glint::daemon
