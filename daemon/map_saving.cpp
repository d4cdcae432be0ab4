// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/map_saving.hpp"

#include <fmt/format.h>

#include "slam/store/session_copy.hpp"

namespace glint::daemon {

std::optional<Json> save_map(const MapSaving& saving, Runtime& runtime, RunningJob& job) {
  if (!runtime.commit_session(job)) return std::nullopt;
  saving.maps.make_place();
  const auto copy =
      slam::copy_session(saving.session_file, saving.maps.file_of(saving.name), stage_clock(),
                         [&](double share) { return job.progress(share); });
  if (!copy) return std::nullopt;
  return Json{{"name", saving.name},
              {"bytes", copy->bytes},
              {"checksum", fmt::format("{:016x}", copy->checksum)},
              {"seconds", copy->seconds}};
}

}  // namespace glint::daemon
