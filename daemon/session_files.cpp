// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include "daemon/protocol.hpp"
#include "daemon/server.hpp"
#include "driver/core/error.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

/// What SQLite keeps beside a database that is being written.
constexpr std::array kCompanions = {"-wal", "-shm"};

struct OwnSession {
  fs::path file;
  std::uint64_t bytes = 0;
  fs::file_time_type written;
};

/// With its companions: what was written last may still be in the log.
OwnSession look_at(const fs::path& file) {
  OwnSession session;
  session.file = file;
  session.written = fs::file_time_type::min();
  const auto add = [&](const fs::path& part) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(part, error);
    if (error) return;
    session.bytes += bytes;
    const auto written = fs::last_write_time(part, error);
    if (!error) session.written = std::max(session.written, written);
  };
  add(file);
  for (const char* companion : kCompanions) add(file.string() + companion);
  return session;
}

/// Length of the way through the keyframes, m; segments are not linked.
double way_m(const std::vector<slam::KeyframePose>& poses) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].segment != poses[i - 1].segment) continue;
    sum_m += (poses[i].T_map_sensor.translation_m - poses[i - 1].T_map_sensor.translation_m).norm();
  }
  return sum_m;
}

double duration_s(const std::vector<slam::SessionSegment>& segments) {
  double sum_s = 0.0;
  for (const slam::SessionSegment& segment : segments) {
    sum_s += static_cast<double>(segment.last_stamp - segment.first_stamp) * kSecondsPerNs;
  }
  return sum_s;
}

/// Nanoseconds since 1970.
std::int64_t last_written_ns(const fs::path& file) {
  const auto time = fs::file_time_type::clock::to_sys(fs::last_write_time(file));
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

/// The one not written to for longest first.
std::vector<OwnSession> look_at_all(const fs::path& directory) {
  std::vector<OwnSession> sessions;
  for (const fs::path& file : session_files(directory)) {
    if (file.filename().string().starts_with(kSessionPrefix)) sessions.push_back(look_at(file));
  }
  std::ranges::stable_sort(sessions, {}, &OwnSession::written);
  return sessions;
}

}  // namespace

fs::path state_directory(const Config& config) {
  return resolve_auto(config.state.directory, "STATE_DIRECTORY", "");
}

std::vector<fs::path> session_files(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == kSessionSuffix) files.push_back(entry.path());
  }
  if (error) {
    throw InputError(fmt::format("cannot list {}: {}; name a directory with sessions in it",
                                 directory.string(), error.message()));
  }
  std::ranges::sort(files);
  return files;
}

void remove_session(const fs::path& file, std::error_code& error) {
  // The session last: were its companions left, nothing would ever find them again.
  for (const char* companion : kCompanions) {
    fs::remove(file.string() + companion, error);
    if (error) return;
  }
  fs::remove(file, error);
}

Json describe_session(const fs::path& file) {
  Json out = Json::object();
  try {
    const slam::SessionReader session(file, slam::SessionCheck::kVersion);
    const auto poses = session.poses();
    const auto segments = session.segments();
    const std::int64_t saved_ns = last_written_ns(file);
    out["bytes"] = fs::file_size(file);
    out["keyframes"] = poses.size();
    out["segments"] = segments.size();
    out["loops"] = session.loop_edges().size();
    out["way_m"] = way_m(poses);
    out["duration_s"] = duration_s(segments);
    out["saved_ns"] = saved_ns;
    out["saved"] = time_string(saved_ns);
  } catch (const std::runtime_error& error) {
    // InputError, or that the file went away meanwhile.
    out = Json{{"error", error.what()}};
  }
  return out;
}

std::vector<fs::path> own_sessions(const fs::path& directory) {
  std::vector<fs::path> files;
  for (const OwnSession& session : look_at_all(directory)) files.push_back(session.file);
  return files;
}

std::vector<RemovedSession> remove_old_sessions(const fs::path& directory, std::uint64_t most_bytes,
                                                const fs::path& current) {
  const std::vector<OwnSession> sessions = look_at_all(directory);
  std::uint64_t bytes = 0;
  for (const OwnSession& session : sessions) bytes += session.bytes;
  std::vector<RemovedSession> removed;
  for (const OwnSession& session : sessions) {
    if (bytes <= most_bytes) break;
    if (session.file.filename() == current.filename()) continue;
    std::error_code error;
    remove_session(session.file, error);
    if (error) continue;
    bytes -= session.bytes;
    removed.push_back({session.file, session.bytes});
  }
  return removed;
}

}  // namespace glint::daemon
