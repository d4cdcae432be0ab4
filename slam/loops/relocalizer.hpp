// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"
#include "slam/loops/look_alike.hpp"
#include "slam/loops/loop_verifier.hpp"
#include "slam/loops/place.hpp"
#include "slam/loops/place_index.hpp"
#include "slam/loops/place_shelf.hpp"
#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

/// A keyframe of the map that a scan sees.
struct PlaceSighting {
  LoopEdge edge;       ///< From the keyframe to the scan.
  Pose T_odom_sensor;  ///< Of the scan.
};

/// About where in a map a sensor is: a help for the search, which it may be wrong for.
struct PlaceGuess {
  Pose T_map_sensor;
  double sigma_m = 3.0;
  bool knows_heading = true;  ///< Else only the position of T_map_sensor says something.
};

/// Where a sensor was found in a map.
struct Relocation {
  Pose T_map_sensor;                     ///< Of the scan that was asked about last.
  std::vector<PlaceSighting> sightings;  ///< Of the scans that agree, in order.
};

/// Says where in a map a sensor is that may be anywhere in it, turned any way: what its scan looks
/// like proposes keyframes of the map; keypoints, surfaces and what either place shows decide about
/// each, as for a loop; three scans whose places go together with the odometry between them are
/// believed, if no other place fits nearly as well. When in doubt it says nothing: a sensor that is
/// elsewhere is never found. Deterministic. Thread-compatible.
class Relocalizer {
 public:
  explicit Relocalizer(std::shared_ptr<const Vocabulary> vocabulary);

  /// A keyframe of the map, in the order of its session, and where the map has it. A bare one is
  /// no place to be found.
  void remember(const Keyframe& keyframe, const Pose& T_map_sensor);
  /// The same for one whose words are known: what else it shows is read when it is looked at.
  void remember_unread(std::uint64_t keyframe, std::uint32_t segment, const Pose& T_map_sensor,
                       const BagOfWords& words);
  /// What reads those; to be called before the first of them.
  void read_with(PlaceShelf::Read read) { places_.read_with(std::move(read)); }
  [[nodiscard]] std::size_t place_count() const { return places_.size(); }
  /// Theirs, in that order; their odometry is the map.
  [[nodiscard]] PlaceShelf& places() { return places_; }

  /// Looks for the place of a scan. What odometry says of its motion since the scans before it
  /// counts; those of other segments are forgotten.
  std::optional<Relocation> locate(const Keyframe& scan);
  /// What the last locate() looked at closely.
  [[nodiscard]] const std::vector<LoopCandidate>& candidates() const { return candidates_; }
  /// How near the last locate() came to a place that it believes in, 0 to 1.
  [[nodiscard]] double confidence() const { return confidence_; }
  /// Forgets the scans and the guess, not the map.
  void begin_anew();
  /// Begins anew, and first looks only about where the next scan is thought to be taken. Where some
  /// scans do not bear that out, the guess is dropped and all of the map is searched.
  void begin_near(const PlaceGuess& guess);
  /// Whether the last locate() dropped the guess.
  [[nodiscard]] bool guess_dropped() const { return guess_dropped_; }

 private:
  /// A place where a scan fits.
  struct Fit {
    std::size_t candidate = 0;
    LoopEdge edge;
    Pose T_map_sensor;
    Comparison there;  ///< What the scan shows, in the map.
    Comparison here;   ///< What the map shows, in the scan.
  };
  struct Scan {
    Pose T_odom_sensor;
    double path_m = 0.0;
    std::vector<Fit> fits;
  };
  /// Fits that agree by odometry, with the numbers of their scans.
  struct Hypothesis {
    std::vector<std::pair<std::size_t, const Fit*>> fits;
    int contradictions_there = 0;
    int contradictions_here = 0;
  };

  /// A guess, and what has become of it.
  struct Expectation {
    PlaceGuess guess;
    std::optional<Pose> T_odom_first;  ///< Of the scan that it is for.
    int scans = 0;                     ///< That were looked for there.
  };

  void note_guess(const Pose& T_odom_sensor);
  [[nodiscard]] bool is_expected(const Pose& T_map_sensor, const Pose& T_odom_sensor) const;
  [[nodiscard]] std::vector<std::size_t> near_guess(std::span<const ScoredPlace> found,
                                                    const Pose& T_odom_sensor) const;
  [[nodiscard]] std::vector<std::size_t> likeliest(const BagOfWords& bag,
                                                   const Pose& T_odom_sensor);
  void judge(std::size_t entry, const Place& current, LoopCandidate& candidate, Scan& scan);
  [[nodiscard]] bool agree(const Scan& a, const Fit& fit_a, const Scan& b, const Fit& fit_b) const;
  [[nodiscard]] Hypothesis gather(const Scan& of, const Fit& fit) const;
  [[nodiscard]] bool has_rival(const Hypothesis& place) const;
  [[nodiscard]] static bool credible(const Hypothesis& place);
  [[nodiscard]] static bool rivals(const Hypothesis& place, const Hypothesis& other);
  std::optional<Relocation> decide();

  const std::shared_ptr<const Vocabulary> vocabulary_;
  PlaceIndex index_;
  LoopVerifier verifier_;
  PlaceShelf places_;
  std::deque<Scan> scans_;     ///< That were asked about; the current one is the last.
  std::uint32_t segment_ = 0;  ///< Of these.
  std::optional<Expectation> expected_;
  bool guess_dropped_ = false;
  std::vector<LoopCandidate> candidates_;
  double confidence_ = 0.0;
};

}  // namespace glint::slam
