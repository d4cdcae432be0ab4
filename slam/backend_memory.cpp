// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How a back end stays within the memory that it may take.
#include <malloc.h>

#include <system_error>

#include "slam/backend.hpp"

namespace glint::slam {
namespace {

constexpr std::size_t kBytesPerMb = 1'000'000;
// From this share of the limit on, what is seldom asked for goes to the disk.
constexpr double kBeginShare = 0.8;
// What a keyframe takes in the graph, about: poses, covariances, what tells loops that contradict.
constexpr std::size_t kNodeBytes = 1200;

}  // namespace

std::size_t Backend::memory_bytes() const {
  return graph_.nodes().size() * kNodeBytes + (map_ ? map_->bytes() : 0) +
         (loops_.bytes ? loops_.bytes() : 0);
}

void Backend::keep_within_memory() {
  memory_ = {memory_bytes(), cold_ ? cold_->bytes() : 0, false};
  const std::size_t limit = static_cast<std::size_t>(config_.map_memory_mb) * kBytesPerMb;
  const auto begin = static_cast<std::size_t>(kBeginShare * static_cast<double>(limit));
  if (limit == 0 || memory_.bytes <= begin || !map_) return;
  if (!cold_tried_) {
    std::error_code ignored;
    cold_ = ColdFile::create(session_file_.empty() ? std::filesystem::temp_directory_path(ignored)
                                                   : session_file_.parent_path());
    cold_tried_ = true;
  }
  if (cold_) {
    if (loops_.set_aside) loops_.set_aside(*cold_);
    const std::size_t others = memory_bytes() - map_->bytes();
    map_->keep_within(cold_, begin > others ? begin - others : 0);
    cold_->rest();
    memory_ = {memory_bytes(), cold_->bytes(), false};
  }
  memory_.full = memory_.bytes > limit;
}

// All that moved with a correction was made anew; what it was before leaves holes, which grew to
// half of the memory in an hour where nobody asked the allocator for them.
void Backend::give_back_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace glint::slam
