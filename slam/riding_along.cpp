// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/riding_along.hpp"

#include <cstddef>

namespace glint::slam {
namespace {

// A way that is foretold is certain if it is so many times its deviation; what then moved by less
// than this share of it rides along.
constexpr double kSure = 6.0;
constexpr double kRidingShare = 0.3;

}  // namespace

void leave_out_riding_along(std::span<const Eigen::Vector3d> then_m, const Pose& T_reference_then,
                            std::span<const Eigen::Vector3d> now_m, const Pose& T_reference_now,
                            double sigma_m, std::vector<Match>& matches) {
  std::erase_if(matches, [&](const Match& match) {
    const Eigen::Vector3d& here_m = now_m[static_cast<std::size_t>(match.current)];
    const Eigen::Vector3d before_m =
        T_reference_then * then_m[static_cast<std::size_t>(match.reference)];
    const double foretold_m = (T_reference_now * here_m - here_m).norm();
    return foretold_m > kSure * sigma_m && (before_m - here_m).norm() < kRidingShare * foretold_m;
  });
}

}  // namespace glint::slam
