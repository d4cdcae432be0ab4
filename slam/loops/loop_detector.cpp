// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_detector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/loops/look_alike.hpp"

namespace glint::slam {
namespace {

// A place is not looked for again before so long a time and way.
constexpr double kGap_s = 30.0;
constexpr double kGap_m = 10.0;
// Similarity that makes a candidate, relative to that of two keyframes in a row, which itself is
// never taken for less than the second value.
constexpr double kLeastSimilarity = 0.3;
constexpr double kLeastReference = 0.05;
// Older keyframes this near to one another (in number) are one region.
constexpr std::size_t kRegionReach = 5;
constexpr int kStreak = 3;
// Regions that are looked at, and of them those whose keypoints are matched.
constexpr std::size_t kMostRegions = 10;
constexpr std::size_t kMostMatched = 3;
// Keyframes before and after the older one whose points make the surfaces around it.
constexpr std::size_t kAround = 5;
// The same where shape alone speaks for a place, and keyframes before the current one whose points
// are taken together with its own.
constexpr std::size_t kShapeAround = 10;
constexpr std::size_t kShapeBefore = 10;
// So many times more must bear it out.
constexpr double kShapeNeeds = 2.0;
// Keyframes on either side of a place whose keypoints are taken together with its own.
constexpr std::size_t kBeside = 2;
// A loop says most of what those just after it would; and where so many have been found so near to
// one another, another pass needs few to be held to the map.
constexpr double kLoopEvery_m = 1.0;
constexpr double kLoopEveryCrowded_m = 4.0;
constexpr double kCrowd_m = 2.0;
constexpr int kCrowd = 4;
// What waits longer to be borne out is given up.
constexpr double kLongestWait_m = 15.0;
// What a place takes in the indices, about: its words, and a fourth of the map around it.
constexpr std::size_t kIndexBytes = 10'000;
// The last places are looked at with each keyframe: they stay in memory.
constexpr std::size_t kWarm = 50;
// What odometry may have erred by.
constexpr double kMostDrift_m = 15.0;
constexpr double kMostDriftShare = 0.05;
constexpr double kMostTurn_rad = 0.8;
// Height errs less, for gravity is seen; other storeys may look alike.
constexpr double kMostRise_m = 1.25;
constexpr double kMostRiseShare = 0.005;

Waypoint waypoint(const Place& place) { return {place.segment, place.path_m, place.T_odom_sensor}; }

std::size_t apart(std::size_t a, std::size_t b) { return a > b ? a - b : b - a; }

}  // namespace

LoopDetector::LoopDetector(std::shared_ptr<const Vocabulary> vocabulary, bool density, bool thins)
    : vocabulary_(std::move(vocabulary)), thins_(thins), index_(vocabulary_->word_count()) {
  if (density) density_.emplace();
}

void LoopDetector::remember(const Keyframe& keyframe) {
  if (is_bare(keyframe)) return;
  append(keyframe);
  last_bag_ = vocabulary_->bag_of(places_.back().descriptors);
  index_.add(last_bag_);
  if (density_) density_->keep(places_);
}

std::size_t LoopDetector::bytes() const {
  std::size_t bytes = places_.size() * kIndexBytes;
  for (const Place& place : places_) bytes += bytes_of(place);
  return bytes;
}

void LoopDetector::set_aside(ColdFile& file) {
  for (; cold_ + kWarm < places_.size(); ++cold_) glint::slam::set_aside(places_[cold_], file);
}

std::vector<LoopEdge> LoopDetector::add(const Keyframe& keyframe) {
  candidates_.clear();
  append(keyframe);
  let_places_age();
  BagOfWords bag = vocabulary_->bag_of(places_.back().descriptors);
  propose(bag);
  if (density_) density_->keep(places_);
  std::vector<LoopEdge> edges = verify();
  seen_before_ = see_again();
  if (seen_before_) {
    places_.back().known = true;
    ++known_;
  }
  index_.add(seen_before_ ? BagOfWords{} : bag);
  last_bag_ = std::move(bag);
  forget_known();
  return edges;
}

void LoopDetector::append(const Keyframe& keyframe) {
  Place place = make_place(keyframe);
  if (!places_.empty()) {
    const Place& last = places_.back();
    // A clock that went back tells nothing.
    const double step_s =
        static_cast<double>(keyframe.estimate.stamp - last_stamp_) * kSecondsPerNs;
    place.time_s = last.time_s + std::max(0.0, step_s);
    place.path_m = last.path_m;
    if (last.segment == place.segment) {
      place.path_m += (place.T_odom_sensor.translation_m - last.T_odom_sensor.translation_m).norm();
    }
  }
  last_stamp_ = keyframe.estimate.stamp;
  places_.push_back(std::move(place));
}

// Places of other segments may be found at once: that joins the segments.
void LoopDetector::let_places_age() {
  const Place& current = places_.back();
  for (; aged_ + 1 < places_.size(); ++aged_) {
    const Place& place = places_[aged_];
    if (place.segment != current.segment) continue;
    if (current.time_s - place.time_s < kGap_s || current.path_m - place.path_m < kGap_m) return;
  }
}

void LoopDetector::propose(const BagOfWords& bag) {
  std::swap(last_regions_, regions_);
  regions_.clear();
  const double reference = std::max(kLeastReference, similarity(last_bag_, bag));
  std::vector<ScoredPlace> found = index_.query(bag, aged_, kLeastSimilarity * reference);
  std::ranges::stable_sort(found, std::ranges::greater{}, &ScoredPlace::similarity);
  for (const ScoredPlace& place : found) {
    // Those next to a better one say the same.
    const auto same = [&](const Region& region) {
      return apart(region.best, place.entry) <= kRegionReach;
    };
    if (std::ranges::any_of(regions_, same)) continue;
    regions_.push_back({place.entry, place.similarity / reference, streak_at(place.entry)});
    if (regions_.size() == kMostRegions) break;
  }
}

int LoopDetector::streak_at(std::size_t entry) const {
  int longest = 0;
  for (const Region& before : last_regions_) {
    if (apart(before.best, entry) <= kRegionReach) longest = std::max(longest, before.streak);
  }
  return longest + 1;
}

std::vector<LoopEdge> LoopDetector::verify() {
  const double path_m = places_.back().path_m;
  const std::vector<PlacePair>& loops = evidence_.loops();
  if (!loops.empty() && path_m - loops.back().current.path_m < least_way_m(loops.back())) return {};
  judged_.clear();
  for (const Region& region : regions_) {
    if (region.streak < kStreak) continue;
    if (candidates_.size() == kMostMatched) break;
    LoopCandidate& candidate = candidates_.emplace_back();
    candidate.similarity = region.similarity;
    judge(region.best, candidate);
  }
  if (density_ && std::ranges::none_of(judged_, &Judged::alike)) verify_shape();
  for (const Judged& judged : judged_) {
    if (!judged.alike) evidence_.speak_against(judged.pair);
  }
  std::erase_if(judged_, [](const Judged& judged) { return !judged.alike; });
  if (judged_.empty()) return {};
  const Judged* const best = choose();
  if (best == nullptr) {
    refuse("another place fits as well");
    return {};
  }
  evidence_.speak_for(best->pair);
  if (!evidence_.convincing(best->pair, best->by_shape ? kShapeNeeds : 1.0)) {
    refuse("not yet borne out by other keyframes");
    wait(*best);
    return {};
  }
  if (evidence_.foreseen(best->pair) == false) {
    refuse("the loop before contradicts it");
    return {};
  }
  refuse("another place goes better with the loop before");
  return accept(*best);
}

// From that loop to the next.
double LoopDetector::least_way_m(const PlacePair& loop) const {
  if (!thins_) return kLoopEvery_m;
  const auto beside = std::ranges::count_if(evidence_.loops(), [&](const PlacePair& other) {
    return other.older.segment == loop.older.segment &&
           std::abs(other.older.path_m - loop.older.path_m) < kCrowd_m;
  });
  return beside > kCrowd ? kLoopEveryCrowded_m : kLoopEvery_m;
}

void LoopDetector::wait(const Judged& judged) {
  const double path_m = judged.pair.current.path_m;
  std::erase_if(waiting_, [&](const Waiting& before) {
    return path_m - before.pair.current.path_m > kLongestWait_m;
  });
  if (!waiting_.empty() && path_m - waiting_.back().pair.current.path_m < kLoopEvery_m) return;
  waiting_.push_back({candidates_[judged.candidate], judged.edge, judged.pair});
}

std::vector<LoopEdge> LoopDetector::accept(const Judged& judged) {
  const auto say_so = [](LoopCandidate& candidate) {
    candidate.reason.clear();
    candidate.accepted = true;
  };
  say_so(candidates_[judged.candidate]);
  evidence_.believe(judged.pair);
  std::vector<LoopEdge> edges{judged.edge};
  for (Waiting& before : waiting_) {
    const double since_m = judged.pair.current.path_m - before.pair.current.path_m;
    if (since_m > kLongestWait_m || !evidence_.agree(before.pair, judged.pair)) continue;
    say_so(candidates_.emplace_back(std::move(before.candidate)));
    edges.push_back(before.edge);
  }
  waiting_.clear();
  return edges;
}

// The only one, or the only one that the loop before foresaw.
const LoopDetector::Judged* LoopDetector::choose() const {
  if (judged_.size() == 1) return judged_.data();
  const Judged* chosen = nullptr;
  for (const Judged& judged : judged_) {
    if (evidence_.foreseen(judged.pair) != true) continue;
    if (chosen != nullptr) return nullptr;
    chosen = &judged;
  }
  return chosen;
}

void LoopDetector::refuse(const char* reason) {
  for (const Judged& judged : judged_) candidates_[judged.candidate].reason = reason;
}

void LoopDetector::judge(std::size_t entry, LoopCandidate& candidate) {
  const Place& older = places_[entry];
  const Place& current = places_.back();
  const Consensus start = verifier_.match(older, current, candidate);
  if (!candidate.reason.empty()) return;
  Judged found;
  found.pair = {waypoint(older), waypoint(current), start.T_reference_current};
  // A nearer one has been asked.
  const auto same = [&](const Judged& judged) { return evidence_.agree(judged.pair, found.pair); };
  if (std::ranges::any_of(judged_, same)) {
    candidate.reason = "another keyframe of the same place is more alike";
    return;
  }
  if (!verifier_.registered(older, around(entry, kAround), current, start, candidate, found.edge)) {
    return;
  }
  compare(entry, found, candidate);
}

// Once the surfaces fit.
void LoopDetector::compare(std::size_t entry, Judged& found, LoopCandidate& candidate) {
  found.candidate = candidates_.size() - 1;
  found.pair.T_older_current = found.edge.T_from_to;
  if (!believable(found.edge, places_[entry], places_.back())) {
    candidate.reason = "odometry does not err that far";
    return;
  }
  found.alike = !contradicted(entry, found.edge.T_from_to);
  if (!found.alike) candidate.reason = "the places show different things";
  judged_.push_back(found);
}

void LoopDetector::verify_shape() {
  for (const DensitySearch::Proposal& proposal : density_->propose(places_, aged_)) {
    judge_shape(proposal, candidates_.emplace_back());
  }
}

void LoopDetector::judge_shape(const DensitySearch::Proposal& proposal, LoopCandidate& candidate) {
  const Place& older = places_[proposal.entry];
  const Place& current = places_.back();
  candidate.corners = proposal.corners;
  Judged found;
  found.by_shape = true;
  found.pair = {waypoint(older), waypoint(current), proposal.T_older_current};
  const auto before = around(places_.size() - 1, kShapeBefore);
  if (!verifier_.registered_by_shape(older, around(proposal.entry, kShapeAround), current, before,
                                     proposal.T_older_current, candidate, found.edge)) {
    return;
  }
  found.pair.T_older_current = found.edge.T_from_to;
  const auto same = [&](const Judged& judged) { return evidence_.agree(judged.pair, found.pair); };
  if (std::ranges::any_of(judged_, [&](const Judged& j) { return j.by_shape && same(j); })) {
    candidate.reason = "another keyframe of the same place is more alike";
    return;
  }
  // Few keypoints placed the other one; where the whole map lies, they are better compared.
  std::erase_if(judged_, same);
  compare(proposal.entry, found, candidate);
}

bool LoopDetector::believable(const LoopEdge& edge, const Place& older,
                              const Place& current) const {
  if (older.segment != current.segment) return true;
  const Pose T_older_current = older.T_odom_sensor.inverse() * current.T_odom_sensor;
  const Pose drift = T_older_current.inverse() * edge.T_from_to;
  const double way_m = current.path_m - older.path_m;
  const double rise_m = (older.T_odom_sensor * edge.T_from_to).translation_m.z() -
                        current.T_odom_sensor.translation_m.z();
  if (std::abs(rise_m) > kMostRise_m + kMostRiseShare * way_m) return false;
  // What comes after a wrong turn is off by the turn times the way.
  const double turn_rad = so3_log(drift.rotation).norm();
  return turn_rad < kMostTurn_rad &&
         drift.translation_m.norm() < kMostDrift_m + (kMostDriftShare + turn_rad) * way_m;
}

// Either may lack what the other shows.
bool LoopDetector::contradicted(std::size_t entry, const Pose& T_older_current) const {
  const Place& older = places_[entry];
  const Place& current = places_.back();
  return compare_places(older, around(entry, kBeside), current, T_older_current).contradictions >
             0 ||
         compare_places(current, around(places_.size() - 1, kBeside), older,
                        T_older_current.inverse())
                 .contradictions > 0;
}

std::span<const Place> LoopDetector::around(std::size_t entry, std::size_t reach) const {
  return places_around(places_, entry, reach);
}

}  // namespace glint::slam
