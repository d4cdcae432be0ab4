// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/loops/vocabulary.hpp"

namespace glint::slam {
namespace {

// The edge of the map's voxels when the configuration leaves it open: fine indoors, coarse in
// streets, so that the number of points follows the scene's surface in both.
double voxel_from_median_range_m(const Keyframe& keyframe) {
  std::vector<float> ranges_m;
  ranges_m.reserve(keyframe.points.size());
  for (const MapPoint& p : keyframe.points) ranges_m.push_back(std::hypot(p.x_m, p.y_m, p.z_m));
  if (ranges_m.empty()) return 0.1;
  const auto middle = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / 2);
  std::nth_element(ranges_m.begin(), middle, ranges_m.end());
  return std::clamp(static_cast<double>(*middle) / 40.0, 0.05, 0.5);
}

// A loop that fits the poses as they are as well as right ones do on average moves nothing yet:
// clients are spared a jump of the map that only noise would tell.
constexpr double kFitting = 6.0;

// As far as this the poses may be from where a keyframe was seen before; they are corrected where
// it is more.
constexpr double kSeenAgain_m = 0.3;
constexpr double kSeenAgain_rad = 0.05;
// Keyframes that show nothing new are still kept so often, as poses: odometry is known in parts.
constexpr double kBareEvery_m = 4.0;

bool same_pair(const LoopEdge& a, const LoopEdge& b) { return a.from == b.from && a.to == b.to; }

LargestCorrection largest_of(std::span<const Pose> before, std::span<const Pose> after) {
  LargestCorrection largest;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Pose motion = before[i].inverse() * after[i];
    largest.distance_m = std::max(largest.distance_m, motion.translation_m.norm());
    largest.angle_rad = std::max(largest.angle_rad, so3_log(motion.rotation).norm());
  }
  return largest;
}

std::unique_ptr<SessionStore> make_store(const std::filesystem::path& file,
                                         const SlamConfig& config, Clock clock) {
  if (file.empty()) return nullptr;
  auto store = std::make_unique<SessionStore>(file, SessionStoreOptions{.clock = clock});
  store->set_meta("preset", config.preset);
  return store;
}

}  // namespace

Backend::Backend(const SlamConfig& config, const std::filesystem::path& session_file, Clock clock,
                 LoopSource loops, const std::filesystem::path& earlier, MapUse use,
                 std::function<void()> alive)
    : config_(config),
      session_file_(session_file),
      clock_(clock),
      loops_(config.loops ? std::move(loops) : LoopSource{}),
      alive_(std::move(alive)),
      graph_({config.pgo_gravity, config.loop_consistency}),
      store_(earlier.empty() ? make_store(session_file, config, clock) : nullptr),
      snapshot_(std::make_shared<const MapSnapshot>()) {
  if (!session_file.empty() && loops_) vocabulary_ = open_vocabulary(config.vocabulary);
  // Words of one vocabulary say nothing in another.
  if (store_ && vocabulary_) {
    store_->set_meta("vocabulary_hash", fmt::format("{:016x}", vocabulary_->hash()));
  }
  if (!earlier.empty()) load(earlier, use);
}

Backend::~Backend() = default;

void Backend::use_sensor(const SensorInfo& info) {
  sensor_ = std::make_shared<const SensorInfo>(info);
  if (store_) store_->set_sensor(info);
}

void Backend::process(const Keyframe& keyframe) {
  const std::uint32_t epoch_before = correction_.epoch;
  times_ = {};
  const StageTimer timer(clock_, times_, Stage::kBackend);
  loop_reports_.clear();
  stamp_ = keyframe.estimate.stamp;
  if (restoring_) restore_some(kRestoredWithEach);
  if (searches_new_segments_ && begins_segment(keyframe)) search_anew();
  if (localizer_) {
    localizer_->process(keyframe, correction_);
  } else if (search_) {
    search_place(renumbered(keyframe));
  } else if (!keyframe.probe) {
    take(renumbered(keyframe));
  }
  store_changes();
  keep_session();
  keep_within_memory();
  publish();
  if (correction_.epoch != epoch_before) give_back_memory();
}

// Into graph, map and session; of what is known already no more than the graph needs.
void Backend::take(Keyframe keyframe) {
  if (!map_) make_map(keyframe);
  leave_out_moving(keyframe);
  LoopSearch found;
  if (loops_ && !memory_.full) found = loops_.search(keyframe);
  if (shows_nothing_new(keyframe, found)) {
    if (!is_needed(keyframe, found)) return take_loops(found);
    keyframe.points.clear();
    keyframe.features = {};
  }
  {
    const StageTimer pgo(clock_, times_, Stage::kPgo);
    graph_.add(keyframe);
  }
  const Pose T_map_sensor = graph_.poses().back();
  if (memory_.full) {
    map_->skip_view(keyframe.points.size());
  } else {
    map_->insert(T_map_sensor, keyframe.points);
  }
  if (store_) store_->add(keyframe, T_map_sensor, words_of(keyframe));
  take_loops(found);
  if (graph_.tilted()) settle();
}

// Whether what the keyframe shows is in the map, which has it where the loops have it.
bool Backend::shows_nothing_new(const Keyframe& keyframe, const LoopSearch& found) const {
  if (!found.seen_before) return false;
  const auto older = graph_.pose(found.seen_before->keyframe);
  if (!older || graph_.nodes().back().segment != keyframe.estimate.segment) return false;
  const Pose off = (*older * found.seen_before->T_older_current).inverse() * graph_.next(keyframe);
  return off.translation_m.norm() < kSeenAgain_m && so3_log(off.rotation).norm() < kSeenAgain_rad;
}

// A loop needs it, or the way since the one before is long.
bool Backend::is_needed(const Keyframe& keyframe, const LoopSearch& found) const {
  const Pose& last = graph_.nodes().back().T_odom_sensor;
  const Pose& now = keyframe.estimate.T_odom_sensor;
  return !found.edges.empty() || (now.translation_m - last.translation_m).norm() > kBareEvery_m;
}

void Backend::leave_out_moving(Keyframe& keyframe) {
  if (config_.moving_objects) keyframe.points = moving_.standing(keyframe);
}

void Backend::finish(Ending ending) {
  times_ = {};
  const StageTimer timer(clock_, times_, Stage::kBackend);
  loop_reports_.clear();
  go_on_unfound();
  bool changed = restoring_.has_value();
  while (ending == Ending::kWhole && restoring_) restore_some(kRestoredWithEach);
  if (search_ && search_->found) {
    settle_down();
    changed = true;
  }
  if (loops_waiting_) {
    settle();
    changed = true;
  }
  if (changed) {
    store_changes();
    publish();
  }
  if (store_) store_->commit();
}

void Backend::keep_session() {
  if (store_) store_->commit_if_due();
}

// The session says how the map was made of its keyframes.
void Backend::make_map(const Keyframe& first) {
  const double voxel_m =
      config_.map_voxel_m > 0 ? config_.map_voxel_m : voxel_from_median_range_m(first);
  map_.emplace(voxel_m, static_cast<std::size_t>(config_.map_max_points));
  if (!store_) return;
  store_->set_meta("map_voxel_m", fmt::format("{}", voxel_m));
  store_->set_meta("map_max_points", fmt::format("{}", config_.map_max_points));
  store_->set_meta("moving_objects", config_.moving_objects ? "removed" : "kept");
}

// A correction that no new loop asks for.
void Backend::settle() {
  for (const LoopEdge& edge : optimize()) {
    report_refused(edge, "other loops contradict it");
    ++loops_rejected_;
  }
}

void Backend::take_loops(LoopSearch& found) {
  for (LoopCandidate& candidate : found.candidates) {
    loop_reports_.push_back({stamp_, std::move(candidate), {}, {}, {}});
  }
  take_loops(found.edges);
  loops_rejected_ += static_cast<std::uint64_t>(std::ranges::count_if(
      loop_reports_, [](const LoopReport& report) { return !report.candidate.accepted; }));
}

// The graph's word on edges that appearance and geometry speak for.
void Backend::take_loops(std::span<const LoopEdge> edges) {
  bool surprising = false;
  for (const LoopEdge& edge : edges) {
    LoopReport& report = report_of(edge);
    report.candidate.accepted = true;
    report.before = report.after = graph_.misfit(edge);
    if (!report.before) {
      report.candidate.accepted = false;
      report.candidate.reason = "its keyframes or its covariance are none of the graph's";
      continue;
    }
    surprising |= !graph_.joined(edge) || report.before->chi_squared > kFitting;
    graph_.add_loop(edge);
    changes_.added.push_back(edge);
    loops_waiting_ = true;
  }
  if (!surprising) return;
  for (const LoopEdge& refused : optimize()) {
    const auto is_it = [&](const LoopEdge& edge) { return same_pair(edge, refused); };
    if (std::ranges::none_of(edges, is_it)) {
      report_refused(refused, "loops found later contradict it");
      continue;
    }
    LoopReport& report = report_of(refused);
    report.candidate.accepted = false;
    report.candidate.reason = "other loops contradict it";
    std::erase_if(changes_.added, is_it);
  }
  for (const LoopEdge& edge : edges) {
    LoopReport& report = report_of(edge);
    report.after = graph_.misfit(edge);
    report.correction = last_correction_;
  }
}

// What stood against it is gone.
void Backend::report_restored(const LoopEdge& edge) {
  LoopReport& report = report_of(edge);
  report.candidate.accepted = true;
  report.candidate.reason.clear();
  report.after = graph_.misfit(edge);
  report.correction = last_correction_;
  changes_.added.push_back(edge);
}

// That of its candidate, or a new one. Valid until the next.
LoopReport& Backend::report_of(const LoopEdge& edge) {
  const auto is_of_edge = [&](const LoopReport& report) {
    return report.candidate.from == edge.from && report.candidate.to == edge.to;
  };
  const auto known = std::ranges::find_if(loop_reports_, is_of_edge);
  if (known != loop_reports_.end()) return *known;
  LoopReport& report = loop_reports_.emplace_back();
  report.stamp = stamp_;
  report.candidate.from = edge.from;
  report.candidate.to = edge.to;
  return report;
}

void Backend::report_refused(const LoopEdge& edge, const char* reason) {
  LoopReport& report = loop_reports_.emplace_back();
  report.stamp = stamp_;
  report.candidate.from = edge.from;
  report.candidate.to = edge.to;
  report.candidate.reason = reason;
  report.after = graph_.misfit(edge);
  changes_.removed.push_back(edge);
}

// Returns the edges that did not fit and are gone.
std::vector<LoopEdge> Backend::optimize() {
  const std::vector<Pose> before(graph_.poses().begin(), graph_.poses().end());
  std::vector<LoopEdge> refused;
  {
    const StageTimer pgo(clock_, times_, Stage::kPgo);
    refused = graph_.optimize();
  }
  loops_waiting_ = false;
  last_correction_ = largest_of(before, graph_.poses());
  if (last_correction_.distance_m > 0.0 || last_correction_.angle_rad > 0.0) correct(before);
  for (const LoopEdge& edge : graph_.restored()) report_restored(edge);
  return refused;
}

// Tells of the poses as the graph has them now: correction, map and session follow.
void Backend::correct(const std::vector<Pose>& before) {
  auto anchors = std::make_shared<std::vector<CorrectionAnchor>>();
  std::vector<Pose> T_new_old;
  changes_.poses.clear();
  for (std::size_t i = 0; i < before.size(); ++i) {
    const GraphNode& node = graph_.nodes()[i];
    const Pose& T_map_sensor = graph_.poses()[i];
    if (node.segment >= first_segment_) {
      anchors->push_back({odometry_segment(node.segment), node.sequence,
                          T_map_sensor * node.T_odom_sensor.inverse()});
    }
    T_new_old.push_back(T_map_sensor * before[i].inverse());
    changes_.poses.emplace_back(node.id, T_map_sensor);
  }
  correction_ = {anchors->back().T_map_odom, correction_.epoch + 1, true, 1.0, anchors, {}};
  map_->move(T_new_old);
}

void Backend::store_changes() {
  LoopChanges changes = std::exchange(changes_, {});
  if (!store_) return;
  for (const LoopReport& report : loop_reports_) {
    changes.events.push_back({report.stamp, "loop", to_json(report).dump()});
  }
  store_->apply(changes);
}

void Backend::publish() {
  if (!map_) return;
  auto snapshot = map_->snapshot();
  snapshot->keyframe_count = graph_.nodes().size();
  snapshot->epoch = correction_.epoch;
  snapshot_ = std::move(snapshot);
}

std::uint64_t Backend::keyframes_not_stored() const {
  if (!no_session_because_.empty()) return graph_.nodes().size();
  return store_ ? store_->missing_keyframes() : 0;
}

std::string_view Backend::store_error() const {
  return store_ ? store_->error() : std::string_view{no_session_because_};
}

}  // namespace glint::slam
