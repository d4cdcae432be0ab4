// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/merge/merged_view.hpp"

#include <cmath>

#include "slam/loops/same_view.hpp"

namespace glint::slam {
namespace {

constexpr double kBeside_m = 0.5;
constexpr double kBeside_rad = 15.0 * M_PI / 180.0;

}  // namespace

bool MergedView::adds_nothing(std::size_t node, std::size_t session, const Keyframe& keyframe) {
  if (const Kept* const kept = nearest(node, session)) {
    const JoinedSession& of = map_.sessions()[kept->session];
    const auto other =
        of.session->keyframe(map_.graph().nodes()[kept->node].id - of.first_keyframe);
    const Pose T_kept_this =
        map_.graph().poses()[kept->node].inverse() * map_.graph().poses()[node];
    if (other && shows_the_same(other->keyframe.points, keyframe.points, T_kept_this)) return true;
  }
  kept_.push_back({node, session});
  return false;
}

// Of those of other sessions that hold together with it.
const MergedView::Kept* MergedView::nearest(std::size_t node, std::size_t session) const {
  const std::span<const Pose> poses = map_.graph().poses();
  const Kept* best = nullptr;
  double best_m = kBeside_m;
  for (const Kept& kept : kept_) {
    if (kept.session == session) break;  // They come in order.
    const double apart_m = (poses[kept.node].translation_m - poses[node].translation_m).norm();
    if (apart_m > best_m || groups_[kept.node] != groups_[node]) continue;
    if (so3_log(poses[kept.node].rotation.conjugate() * poses[node].rotation).norm() >
        kBeside_rad) {
      continue;
    }
    best = &kept;
    best_m = apart_m;
  }
  return best;
}

}  // namespace glint::slam
