// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_record.hpp"

namespace glint::slam {
namespace {

std::size_t rest_of(const KeyframeRecord& keyframe) {
  return keyframe.points.capacity() + keyframe.features.capacity() +
         (keyframe.words ? keyframe.words->capacity() : 0);
}

std::size_t rest_of(const MetaRecord& meta) { return meta.key.size() + meta.value.size(); }

std::size_t rest_of(const SensorRecord& sensor) { return sensor.metadata.size(); }

std::size_t rest_of(const LoopChanges& changes) {
  std::size_t bytes = (changes.added.size() + changes.removed.size()) * sizeof(LoopEdge);
  for (const SessionEvent& event : changes.events) bytes += sizeof event + event.data.size();
  return bytes;
}

}  // namespace

std::size_t bytes_of(const SessionRecord& record) {
  return sizeof record +
         std::visit([](const auto& of_its_kind) { return rest_of(of_its_kind); }, record);
}

}  // namespace glint::slam
