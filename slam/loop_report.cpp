// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loop_report.hpp"

namespace glint::slam {
namespace {

nlohmann::ordered_json to_json(const LoopMisfit& misfit) {
  return {{"distance_m", misfit.distance_m},
          {"angle_rad", misfit.angle_rad},
          {"chi_squared", misfit.chi_squared}};
}

}  // namespace

nlohmann::ordered_json to_json(const LoopReport& report) {
  const LoopCandidate& c = report.candidate;
  nlohmann::ordered_json out{{"from", c.from}, {"to", c.to}, {"accepted", c.accepted}};
  if (!c.reason.empty()) out["reason"] = c.reason;
  if (c.corners > 0) out["corners"] = c.corners;
  out["similarity"] = c.similarity;
  out["matches"] = c.matches;
  out["inliers"] = c.inliers;
  out["overlap"] = c.overlap;
  out["rms_m"] = c.rms_m;
  if (report.before) out["residual_before"] = to_json(*report.before);
  if (report.after) out["residual_after"] = to_json(*report.after);
  if (c.accepted) {
    out["largest_correction_m"] = report.correction.distance_m;
    out["largest_correction_rad"] = report.correction.angle_rad;
  }
  return out;
}

}  // namespace glint::slam
