// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How the map of an earlier session comes back: at once what the search for a place needs, and,
// since all that its keyframes show takes long to read, some of them at a time.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "driver/core/error.hpp"
#include "slam/backend.hpp"
#include "slam/store/session_map.hpp"

namespace glint::slam {
namespace {

// Keyframes that are read at once: small maps are whole after a load.
constexpr std::size_t kRestoredAtOnce = 100;

std::string hash_text(const Vocabulary& vocabulary) {
  return fmt::format("{:016x}", vocabulary.hash());
}

bool are_of(const BagOfWords& words, const Vocabulary& vocabulary) {
  return words.empty() || words.back().word < vocabulary.word_count();
}

// Each look reads a keyframe of its own; what is damaged shows nothing.
PlaceShelf::Read place_reader(std::shared_ptr<const SessionReader> session) {
  return [session = std::move(session)](std::uint64_t id) -> std::optional<Place> {
    try {
      const auto stored = session->keyframe(id);
      return stored ? std::optional(make_place(stored->keyframe)) : std::nullopt;
    } catch (const InputError&) {
      return std::nullopt;
    }
  };
}

}  // namespace

std::optional<BagOfWords> Backend::words_of(const Keyframe& keyframe) const {
  if (!vocabulary_) return std::nullopt;
  return vocabulary_->bag_of(place_descriptors(keyframe.features));
}

// What a session says of words counts if it means those of this vocabulary.
Relocalizer Backend::knowing_places(const std::shared_ptr<const SessionReader>& session,
                                    const std::function<void(const KeyframeOutline&)>& visit) {
  auto vocabulary = vocabulary_ ? vocabulary_ : open_vocabulary(config_.vocabulary);
  const bool same_words = session->meta("vocabulary_hash") == hash_text(*vocabulary);
  Relocalizer relocalizer(vocabulary);
  relocalizer.read_with(place_reader(session));
  session->for_each_outline([&](KeyframeOutline&& outline) {
    if (alive_) alive_();
    const Keyframe& keyframe = outline.keyframe;
    if (!same_words || !outline.words || !are_of(*outline.words, *vocabulary)) {
      outline.words =
          vocabulary->bag_of(place_descriptors(session->keyframe(keyframe.id)->keyframe.features));
    }
    // Without words it could not be found, and may be bare.
    if (!outline.words->empty()) {
      relocalizer.remember_unread(keyframe.id, keyframe.estimate.segment, outline.T_map_sensor,
                                  *outline.words);
    }
    if (visit) visit(outline);
  });
  return relocalizer;
}

// The graph, and where to look for the sensor.
Relocalizer Backend::restore(const std::filesystem::path& file) {
  auto session = std::make_shared<const SessionReader>(file);
  map_.emplace(session_voxel_m(*session), static_cast<std::size_t>(config_.map_max_points));
  Relocalizer relocalizer = knowing_places(session, [this](const KeyframeOutline& outline) {
    graph_.add_at(outline.keyframe, outline.T_map_sensor);
    first_keyframe_ = outline.keyframe.id + 1;
    first_segment_ = outline.keyframe.estimate.segment + 1;
  });
  for (const LoopEdge& loop : session->loop_edges()) graph_.restore_loop(loop);
  const bool without_moving =
      !config_.moving_objects || moving_in_session(*session) == MovingInSession::kRemoved;
  restoring_ = Restoring{std::move(session), 0, without_moving};
  restore_some(kRestoredAtOnce);
  return relocalizer;
}

// The map and what finds loops are made of the next keyframes.
void Backend::restore_some(std::size_t keyframes) {
  Restoring& rest = *restoring_;
  const std::size_t end = std::min(graph_.nodes().size(), rest.done + keyframes);
  try {
    if (rest.done < end) {
      rest.session->for_some_keyframes(graph_.nodes()[rest.done].id, end - rest.done,
                                       [this](SessionKeyframe&& stored) { restore(stored); });
    }
  } catch (const InputError&) {
    // A load is refused for it; later, the rest is still worth having.
    if (!search_ && !localizer_) throw;
    map_->skip_view(0);
    ++rest.done;
    ++unreadable_;
  }
  keep_within_memory();
  if (rest.done >= graph_.nodes().size()) restoring_.reset();
}

void Backend::restore(const SessionKeyframe& stored) {
  if (alive_) alive_();
  const Keyframe& keyframe = stored.keyframe;
  map_->insert(stored.T_map_sensor,
               restoring_->as_stored ? keyframe.points : moving_.standing(keyframe));
  if (loops_.remember) loops_.remember(keyframe);
  ++restoring_->done;
}

bool Backend::restore_more() {
  if (!restoring_) return false;
  loop_reports_.clear();
  restore_some(kRestoredWithEach);
  if (search_ && search_->found && !restoring_) settle_down();
  store_changes();
  publish();
  return true;
}

double Backend::restored() const {
  if (!restoring_ || graph_.nodes().empty()) return 1.0;
  return static_cast<double>(restoring_->done) / static_cast<double>(graph_.nodes().size());
}

}  // namespace glint::slam
