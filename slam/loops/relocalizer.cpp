// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/relocalizer.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "slam/loops/look_alike.hpp"

namespace glint::slam {
namespace {

// Similarity below which a place is not looked at: unlike that of two scans in a row it says little
// by itself.
constexpr double kLeastLikeness = 0.01;
// Keyframes of the map this near to a likelier one (in number) show the same.
constexpr std::size_t kSameSight = 3;
constexpr std::size_t kMostAsked = 10;
constexpr std::size_t kMostFits = 4;
// Keyframes on either side whose points make the surfaces around a place, and whose keypoints
// stand beside its own.
constexpr std::size_t kSurfacesAround = 5;
constexpr std::size_t kStandIns = 5;
// Scans that must agree; so many are remembered, over so much way.
constexpr std::size_t kScansNeeded = 3;
constexpr std::size_t kScansKept = 16;
constexpr double kScanMemory_m = 8.0;
// One keypoints' cube that shows something else is forgiven to so many scans.
constexpr int kScansPerContradiction = 6;
// Another place is out when it has less than this share of the keypoints found, or a cube against
// it in each scan.
constexpr double kRivalShare = 0.8;
// By how much two scans' places may differ from what odometry says.
constexpr double kDisagree_m = 0.3;
constexpr double kDisagreeShare = 0.03;
constexpr double kDisagree_rad = 0.07;

// A guess holds for what is as near as this many of its deviations and as a keyframe may be, and
// turned by no more; it is dropped after so many scans.
constexpr double kGuessSigmas = 3.0;
constexpr double kGuessReach_m = 3.0;
constexpr double kGuessTurn_rad = 0.8;
constexpr int kGuessScans = 12;

std::size_t numbers_apart(std::size_t a, std::size_t b) { return a > b ? a - b : b - a; }

}  // namespace

Relocalizer::Relocalizer(std::shared_ptr<const Vocabulary> vocabulary)
    : vocabulary_(std::move(vocabulary)), index_(vocabulary_->word_count()) {}

void Relocalizer::remember(const Keyframe& keyframe, const Pose& T_map_sensor) {
  if (is_bare(keyframe)) return;
  Place place = make_place(keyframe);
  place.T_odom_sensor = T_map_sensor;
  index_.add(vocabulary_->bag_of(place.descriptors));
  places_.add(std::move(place));
}

void Relocalizer::remember_unread(std::uint64_t keyframe, std::uint32_t segment,
                                  const Pose& T_map_sensor, const BagOfWords& words) {
  index_.add(words);
  places_.add_unread(keyframe, segment, T_map_sensor);
}

void Relocalizer::begin_near(const PlaceGuess& guess) {
  begin_anew();
  expected_ = Expectation{guess, {}, 0};
}

void Relocalizer::begin_anew() {
  expected_.reset();
  scans_.clear();
  candidates_.clear();
  confidence_ = 0.0;
}

std::optional<Relocation> Relocalizer::locate(const Keyframe& keyframe) {
  if (keyframe.estimate.segment != segment_ && !scans_.empty()) begin_anew();
  segment_ = keyframe.estimate.segment;
  candidates_.clear();
  const Place current = make_place(keyframe);
  note_guess(current.T_odom_sensor);
  Scan scan{current.T_odom_sensor, 0.0, {}};
  if (!scans_.empty()) {
    const Scan& last = scans_.back();
    scan.path_m =
        last.path_m + (scan.T_odom_sensor.translation_m - last.T_odom_sensor.translation_m).norm();
  }
  std::erase_if(scans_, [&](const Scan& s) { return scan.path_m - s.path_m > kScanMemory_m; });
  if (scans_.size() == kScansKept) scans_.pop_front();
  for (const std::size_t entry :
       likeliest(vocabulary_->bag_of(current.descriptors), current.T_odom_sensor)) {
    judge(entry, current, candidates_.emplace_back(), scan);
    if (scan.fits.size() == kMostFits) break;
  }
  scans_.push_back(std::move(scan));
  return decide();
}

// The guess is for the first scan after it; after too many it has proved wrong.
void Relocalizer::note_guess(const Pose& T_odom_sensor) {
  guess_dropped_ = expected_ && expected_->scans == kGuessScans;
  if (guess_dropped_) expected_.reset();
  if (!expected_) return;
  ++expected_->scans;
  if (!expected_->T_odom_first) expected_->T_odom_first = T_odom_sensor;
}

// Whether it is where the guess has the scan, as odometry carries it.
bool Relocalizer::is_expected(const Pose& T_map_sensor, const Pose& T_odom_sensor) const {
  if (!expected_) return true;
  const PlaceGuess& guess = expected_->guess;
  const Pose there = guess.T_map_sensor * (expected_->T_odom_first->inverse() * T_odom_sensor);
  const Pose off = there.inverse() * T_map_sensor;
  // Where the heading is not known, nor is the direction that odometry went.
  const double way_m =
      guess.knows_heading ? 0.0 : (there.translation_m - guess.T_map_sensor.translation_m).norm();
  if (off.translation_m.norm() > kGuessReach_m + kGuessSigmas * guess.sigma_m + 2.0 * way_m) {
    return false;
  }
  return !guess.knows_heading || so3_log(off.rotation).norm() < kGuessTurn_rad;
}

// Of `found` those near the guess, then the others near it, which look like something else.
std::vector<std::size_t> Relocalizer::near_guess(std::span<const ScoredPlace> found,
                                                 const Pose& T_odom_sensor) const {
  const auto is_near = [&](std::size_t entry) {
    Pose here = places_.pose(entry);
    // A keyframe shows all around: it may have looked another way.
    here.rotation = expected_->guess.T_map_sensor.rotation *
                    (expected_->T_odom_first->inverse() * T_odom_sensor).rotation;
    return is_expected(here, T_odom_sensor);
  };
  std::vector<std::size_t> entries;
  for (const ScoredPlace& place : found) {
    if (is_near(place.entry)) entries.push_back(place.entry);
  }
  for (std::size_t entry = 0; entry < places_.size(); ++entry) {
    if (is_near(entry)) entries.push_back(entry);
  }
  return entries;
}

// The places most like it, none next to a likelier one.
std::vector<std::size_t> Relocalizer::likeliest(const BagOfWords& bag, const Pose& T_odom_sensor) {
  std::vector<ScoredPlace> found = index_.query(bag, places_.size(), kLeastLikeness);
  std::ranges::stable_sort(found, std::ranges::greater{}, &ScoredPlace::similarity);
  std::vector<std::size_t> order;
  if (expected_) {
    order = near_guess(found, T_odom_sensor);
  } else {
    for (const ScoredPlace& place : found) order.push_back(place.entry);
  }
  std::vector<std::size_t> entries;
  for (const std::size_t entry : order) {
    const auto same = [&](std::size_t better) {
      return numbers_apart(better, entry) <= kSameSight;
    };
    if (std::ranges::any_of(entries, same)) continue;
    entries.push_back(entry);
    if (entries.size() == kMostAsked) break;
  }
  return entries;
}

void Relocalizer::judge(std::size_t entry, const Place& current, LoopCandidate& candidate,
                        Scan& scan) {
  const Place older = places_.at(entry);
  const Consensus start = verifier_.match(older, current, candidate);
  if (!candidate.reason.empty()) return;
  Fit fit;
  fit.candidate = candidates_.size() - 1;
  fit.T_map_sensor = older.T_odom_sensor * start.T_reference_current;
  if (std::ranges::any_of(scan.fits, [&](const Fit& f) { return agree(scan, f, scan, fit); })) {
    candidate.reason = "another keyframe of the same place is more alike";
    return;
  }
  if (!verifier_.registered(older, places_.around(entry, kSurfacesAround), current, start,
                            candidate, fit.edge)) {
    return;
  }
  fit.T_map_sensor = older.T_odom_sensor * fit.edge.T_from_to;
  if (!is_expected(fit.T_map_sensor, current.T_odom_sensor)) {
    candidate.reason = "it is not where the sensor is thought to be";
    return;
  }
  const std::vector<Place> near = places_.nearest(fit.T_map_sensor.translation_m, kStandIns,
                                                  std::numeric_limits<double>::infinity());
  fit.there = compare_places(near.front(), near, current,
                             near.front().T_odom_sensor.inverse() * fit.T_map_sensor);
  fit.here = compare_places(current, {&current, 1}, near.front(),
                            fit.T_map_sensor.inverse() * near.front().T_odom_sensor);
  scan.fits.push_back(std::move(fit));
}

bool Relocalizer::agree(const Scan& a, const Fit& fit_a, const Scan& b, const Fit& fit_b) const {
  const Pose T_a_b = a.T_odom_sensor.inverse() * b.T_odom_sensor;
  const Pose apart = (fit_a.T_map_sensor * T_a_b).inverse() * fit_b.T_map_sensor;
  const double way_m = std::abs(a.path_m - b.path_m);
  return apart.translation_m.norm() < kDisagree_m + kDisagreeShare * way_m &&
         so3_log(apart.rotation).norm() < kDisagree_rad;
}

// What the scans say of the place at which the last of them would be there.
Relocalizer::Hypothesis Relocalizer::gather(const Scan& of, const Fit& fit) const {
  Hypothesis place;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const auto same = [&](const Fit& other) { return agree(scans_[i], other, of, fit); };
    const auto found = std::ranges::find_if(scans_[i].fits, same);
    if (found == scans_[i].fits.end()) continue;
    place.fits.emplace_back(i, &*found);
    place.contradictions_there += found->there.contradictions;
    place.contradictions_here += found->here.contradictions;
  }
  return place;
}

// A place that is seen again shows next to nothing that does not belong there. What stands beside
// a map's keyframe one scan alone may not see well.
bool Relocalizer::credible(const Hypothesis& place) {
  const auto scans = static_cast<int>(place.fits.size());
  return place.contradictions_there * kScansPerContradiction <= scans &&
         place.contradictions_here * 2 <= scans;
}

// Whether the scans that fit both do not show for certain which of the two it is.
bool Relocalizer::rivals(const Hypothesis& place, const Hypothesis& other) {
  double share = 0.0;
  double share_of_other = 0.0;
  int common = 0;
  int against = 0;
  for (const auto& [scan, fit] : place.fits) {
    for (const auto& [other_scan, other_fit] : other.fits) {
      if (scan != other_scan) continue;
      ++common;
      share += fit->there.confirmed;
      share_of_other += other_fit->there.confirmed;
      against += other_fit->there.contradictions - fit->there.contradictions;
    }
  }
  return common > 0 && against < common && share_of_other > kRivalShare * share;
}

std::optional<Relocation> Relocalizer::decide() {
  confidence_ = 0.0;
  const Scan& last = scans_.back();
  for (const Fit& fit : last.fits) {
    LoopCandidate& candidate = candidates_[fit.candidate];
    const Hypothesis place = gather(last, fit);
    const double share = static_cast<double>(place.fits.size()) / kScansNeeded;
    if (!credible(place)) {
      candidate.reason = "the places show different things";
      continue;
    }
    confidence_ = std::max(confidence_, std::min(1.0, share));
    if (place.fits.size() < kScansNeeded) {
      candidate.reason = "not yet borne out by other scans";
    } else if (has_rival(place)) {
      candidate.reason = "another place fits as well";
    } else {
      candidate.accepted = true;
      confidence_ = 1.0;
      Relocation relocation{fit.T_map_sensor, {}};
      for (const auto& [scan, one] : place.fits) {
        relocation.sightings.push_back({one->edge, scans_[scan].T_odom_sensor});
      }
      return relocation;
    }
  }
  return std::nullopt;
}

bool Relocalizer::has_rival(const Hypothesis& place) const {
  const auto is_of_place = [&](const Fit& fit) {
    return std::ranges::any_of(place.fits, [&](const auto& own) { return own.second == &fit; });
  };
  return std::ranges::any_of(scans_, [&](const Scan& scan) {
    return std::ranges::any_of(scan.fits, [&](const Fit& fit) {
      return !is_of_place(fit) && rivals(place, gather(scan, fit));
    });
  });
}

}  // namespace glint::slam
