// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"
#include "slam/loop_source.hpp"
#include "slam/loops/density_search.hpp"
#include "slam/loops/loop_evidence.hpp"
#include "slam/loops/loop_verifier.hpp"
#include "slam/loops/place.hpp"
#include "slam/loops/place_index.hpp"
#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

/// Finds keyframes that see a place again, by what it looks like: bags of visual words propose
/// older keyframes, three keyframes in a row must point to the same place, LoopVerifier looks at
/// each; where that finds none, the shape of the surroundings proposes some (density_search.hpp);
/// nothing may show that it is another place of the same make (look_alike.hpp), and several
/// keyframes must bear one another out (loop_evidence.hpp). When in doubt it is no loop. The poses
/// need not be near one another; they serve to put neighbouring keyframes together and to refuse
/// what no odometry errs by. What is kept of a keyframe is bounded, see Place. The result depends
/// on the keyframes alone. Thread-compatible.
class LoopDetector {
 public:
  /// `density`: the shape of the surroundings proposes places too. `thins`: keyframes that show
  /// nothing that older ones do not are told, and loops are fewer where there are many.
  explicit LoopDetector(std::shared_ptr<const Vocabulary> vocabulary, bool density = true,
                        bool thins = true);

  /// Takes keyframes in order, those of a segment one after the other. The loop to the keyframe, if
  /// it is at a place seen before; at most one, and none in keyframes that follow a loop closely.
  /// After a loop that came as a surprise, those of the keyframes that bore it out follow it.
  std::vector<LoopEdge> add(const Keyframe& keyframe);
  /// The same for a keyframe of a session before, which is to be found but not looked for.
  void remember(const Keyframe& keyframe);
  /// The older keyframe that shows all that the one of the last add() does, where one was found by
  /// a loop just before. Such a keyframe is not found again, and soon forgotten.
  [[nodiscard]] const std::optional<SeenBefore>& seen_before() const { return seen_before_; }
  /// Memory taken by what is known, about, bytes.
  [[nodiscard]] std::size_t bytes() const;
  /// Puts what older keyframes show into the file; it is found as before.
  void set_aside(ColdFile& file);
  /// What the last add() looked at closely, whether it became a loop or not.
  [[nodiscard]] const std::vector<LoopCandidate>& candidates() const { return candidates_; }

 private:
  /// Older keyframes next to one another that look like the current one.
  struct Region {
    std::size_t best = 0;     ///< The one most alike.
    double similarity = 0.0;  ///< Relative to that of neighbouring keyframes.
    int streak = 1;           ///< Keyframes in a row that pointed here.
  };
  /// A candidate whose surfaces fit.
  struct Judged {
    std::size_t candidate = 0;
    LoopEdge edge;
    PlacePair pair;
    bool alike = false;     ///< Nothing shows that it is another place.
    bool by_shape = false;  ///< No keypoints speak for it.
  };
  /// One that waits for other keyframes to bear it out.
  struct Waiting {
    LoopCandidate candidate;
    LoopEdge edge;
    PlacePair pair;
  };

  void append(const Keyframe& keyframe);
  void let_places_age();
  void propose(const BagOfWords& bag);
  [[nodiscard]] int streak_at(std::size_t entry) const;
  std::vector<LoopEdge> verify();
  [[nodiscard]] double least_way_m(const PlacePair& loop) const;
  [[nodiscard]] std::optional<SeenBefore> see_again() const;
  [[nodiscard]] std::optional<std::size_t> nearest_older(const PlacePair& loop,
                                                         const Pose& here) const;
  void forget_known();
  void judge(std::size_t entry, LoopCandidate& candidate);
  void verify_shape();
  void judge_shape(const DensitySearch::Proposal& proposal, LoopCandidate& candidate);
  void compare(std::size_t entry, Judged& found, LoopCandidate& candidate);
  [[nodiscard]] const Judged* choose() const;
  void refuse(const char* reason);
  void wait(const Judged& judged);
  std::vector<LoopEdge> accept(const Judged& judged);
  [[nodiscard]] bool believable(const LoopEdge& edge, const Place& older,
                                const Place& current) const;
  [[nodiscard]] bool contradicted(std::size_t entry, const Pose& T_older_current) const;
  [[nodiscard]] std::span<const Place> around(std::size_t entry, std::size_t reach) const;

  const std::shared_ptr<const Vocabulary> vocabulary_;
  const bool thins_;
  PlaceIndex index_;
  LoopVerifier verifier_;
  std::optional<DensitySearch> density_;
  std::vector<Place> places_;  ///< The current one is the last.
  std::size_t cold_ = 0;       ///< Places before this one were set aside.
  SensorTime last_stamp_;
  BagOfWords last_bag_;
  std::size_t aged_ = 0;  ///< Places before this one are old enough to be found again.
  LoopEvidence evidence_;
  std::vector<Region> regions_;       ///< Of the current keyframe, the likeliest first.
  std::vector<Region> last_regions_;  ///< Of the one before.
  std::vector<LoopCandidate> candidates_;
  std::vector<Waiting> waiting_;           ///< In order; at least kLoopEvery_m of way apart.
  std::vector<Judged> judged_;             ///< Of the current keyframe; no two of them agree.
  std::optional<SeenBefore> seen_before_;  ///< Of the current keyframe.
  std::size_t known_ = 0;                  ///< Places that are to be forgotten.
};

}  // namespace glint::slam
