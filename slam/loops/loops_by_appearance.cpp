// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loops_by_appearance.hpp"

#include <memory>

#include "slam/loops/loop_detector.hpp"

namespace glint::slam {

LoopSource loops_by_appearance(const SlamConfig& config) {
  if (!config.loops) return {};
  // Shared, for a function must be copyable.
  const auto detector = std::make_shared<LoopDetector>(open_vocabulary(config.vocabulary),
                                                       config.loop_density, config.thin_keyframes);
  LoopSource source;
  source.search = [detector](const Keyframe& keyframe) {
    LoopSearch search;
    search.edges = detector->add(keyframe);
    search.candidates = detector->candidates();
    search.seen_before = detector->seen_before();
    return search;
  };
  source.remember = [detector](const Keyframe& keyframe) { detector->remember(keyframe); };
  source.bytes = [detector] { return detector->bytes(); };
  source.set_aside = [detector](ColdFile& file) { detector->set_aside(file); };
  return source;
}

}  // namespace glint::slam
