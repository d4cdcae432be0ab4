// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How a back end goes on with the map of an earlier session.
#include <algorithm>
#include <functional>
#include <utility>

#include "driver/core/error.hpp"
#include "slam/backend.hpp"
#include "slam/loops/vocabulary.hpp"
#include "slam/store/session_copy.hpp"

namespace glint::slam {
namespace {

// What the way between a scan and the keyframe before it may err by.
constexpr double kBetween_m = 0.01;
constexpr double kBetween_rad = 0.002;

// Keyframes that wait for their place to be known: some 200 MB of them. The oldest go first.
constexpr std::size_t kMostWaiting = 500;

// What a scan sees, as what the last keyframe until then would: its number is that of the keyframe
// that follows the scan, if the scan is none.
LoopEdge edge_to_keyframe(const PlaceSighting& sighting, std::span<const Keyframe> keyframes) {
  auto at = std::ranges::upper_bound(keyframes, sighting.edge.to, {}, &Keyframe::id);
  const auto is_it = [&](const Keyframe& keyframe) {
    const Pose between = keyframe.estimate.T_odom_sensor.inverse() * sighting.T_odom_sensor;
    return between.translation_m.isZero(0.0);
  };
  if (at != keyframes.begin()) --at;
  if (at != keyframes.begin() && at->id == sighting.edge.to && !is_it(*at)) --at;
  const Pose T_scan_keyframe = sighting.T_odom_sensor.inverse() * at->estimate.T_odom_sensor;
  LoopEdge edge = sighting.edge;
  edge.to = at->id;
  edge.T_from_to = sighting.edge.T_from_to * T_scan_keyframe;
  const Eigen::Matrix<double, 6, 6> back = adjoint(T_scan_keyframe.inverse());
  Twist between;
  between.head<3>().setConstant(kBetween_m * kBetween_m);
  between.tail<3>().setConstant(kBetween_rad * kBetween_rad);
  edge.covariance = back * sighting.edge.covariance * back.transpose();
  edge.covariance += Eigen::Matrix<double, 6, 6>(between.asDiagonal());
  return edge;
}

}  // namespace

void Backend::begin_at_epoch(std::uint32_t epoch) {
  correction_.epoch = epoch;
  auto snapshot = std::make_shared<MapSnapshot>(*snapshot_);
  snapshot->epoch = epoch;
  snapshot_ = std::move(snapshot);
}

void Backend::load(const std::filesystem::path& session, MapUse use) {
  Relocalizer relocalizer = restore(session);
  if (use == MapUse::kLocalize) {
    localizer_.emplace(std::move(relocalizer));
  } else {
    search_.emplace(PlaceSearch{session, std::move(relocalizer), {}, {}, {}});
  }
  correction_.placed = false;
  correction_.confidence = 0.0;
  ++correction_.epoch;
  keep_within_memory();
  publish();
}

Keyframe Backend::renumbered(const Keyframe& keyframe) const {
  Keyframe out = keyframe;
  out.id += first_keyframe_;
  out.estimate.segment += first_segment_ + static_cast<std::uint32_t>(set_apart_.size());
  return out;
}

void Backend::search_place(const Keyframe& keyframe) {
  if (!search_->begin) search_->begin = keyframe.estimate.stamp;
  std::vector<Keyframe>& waiting = search_->waiting;
  if (!keyframe.probe) waiting.push_back(keyframe);
  if (waiting.size() > kMostWaiting) waiting.erase(waiting.begin());
  if (search_->found) return wait_for_map(keyframe);
  const auto found = search_->relocalizer.locate(keyframe);
  correction_.confidence = search_->relocalizer.confidence();
  // What is of other segments has no way to this place that odometry knows.
  const auto linked = [&](const Keyframe& k) {
    return k.estimate.segment == keyframe.estimate.segment;
  };
  if (!found || std::ranges::none_of(waiting, linked)) return;
  std::erase_if(waiting, std::not_fn(linked));
  search_->found = Found{*found, keyframe.estimate.T_odom_sensor, keyframe.estimate.segment};
  if (!restoring_) return settle_down();
  // The place can be told; what is to be built waits.
  correction_.T_map_odom = found->T_map_sensor * keyframe.estimate.T_odom_sensor.inverse();
  correction_.placed = true;
  ++correction_.epoch;
}

// Odometry carries the place that was found, as long as it can.
void Backend::wait_for_map(const Keyframe& keyframe) {
  if (keyframe.estimate.segment != search_->found->segment) {
    search_->found.reset();
    search_->begin = keyframe.estimate.stamp;
    correction_.placed = false;
    correction_.confidence = 0.0;
    ++correction_.epoch;
  } else if (!restoring_) {
    settle_down();
  }
}

// What was held back goes where the sensor was found.
void Backend::settle_down() {
  const Found found = *std::move(search_->found);
  const std::filesystem::path session = search_->session;
  std::vector<Keyframe> waiting = std::move(search_->waiting);
  const bool whole = !restoring_;
  // Nobody reads the session any more when it is written.
  restoring_.reset();
  search_.reset();
  if (session.empty()) {
    set_apart(waiting);
  } else {
    continue_session(session);
  }
  const Pose T_map_odom = found.relocation.T_map_sensor * found.T_odom_sensor.inverse();
  for (Keyframe& keyframe : waiting) {
    const Pose T_map_sensor = T_map_odom * keyframe.estimate.T_odom_sensor;
    graph_.add_at(keyframe, T_map_sensor);
    leave_out_moving(keyframe);
    if (whole) map_->insert(T_map_sensor, keyframe.points);
    if (store_) store_->add(keyframe, T_map_sensor, words_of(keyframe));
    if (loops_.remember) loops_.remember(keyframe);
  }
  std::vector<LoopEdge> edges;
  for (const PlaceSighting& sighting : found.relocation.sightings) {
    const LoopEdge edge = edge_to_keyframe(sighting, waiting);
    const auto same = [&](const LoopEdge& e) { return e.from == edge.from && e.to == edge.to; };
    if (std::ranges::none_of(edges, same)) edges.push_back(edge);
  }
  take_loops(edges);
  correct({graph_.poses().begin(), graph_.poses().end()});
}

// The session goes on in a file of its own, unless it is the same one. Where that cannot be, the
// disk being full or the earlier session gone, the map goes on without.
void Backend::continue_session(const std::filesystem::path& session) {
  if (session_file_.empty()) return;
  try {
    std::error_code ignored;
    if (!std::filesystem::equivalent(session, session_file_, ignored)) {
      copy_session(session, session_file_, clock_);
    }
    store_ = std::make_unique<SessionStore>(
        session_file_, SessionStoreOptions{.continues = true, .clock = clock_});
  } catch (const InputError& error) {
    no_session_because_ = error.what();
    return;
  }
  if (sensor_) store_->set_sensor(*sensor_);
}

std::vector<Keyframe> Backend::give_up_search() {
  if (!search_) return {};
  std::vector<Keyframe> waiting = std::move(search_->waiting);
  search_.reset();
  for (Keyframe& keyframe : waiting) {
    keyframe.id -= first_keyframe_;
    keyframe.estimate.segment -= first_segment_;
  }
  return waiting;
}

double Backend::searching_s() const {
  if (localizer_) return localizer_->searching_s();
  if (!search_ || !search_->begin || search_->found) return 0.0;
  return static_cast<double>(stamp_ - *search_->begin) * kSecondsPerNs;
}

}  // namespace glint::slam
