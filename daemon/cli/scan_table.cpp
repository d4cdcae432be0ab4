// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/scan_table.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "daemon/cli/text_file.hpp"
#include "daemon/cli/trajectory_writer.hpp"

namespace glint::cli {
namespace {

constexpr std::array<std::string_view, 6> kAxes = {"x", "y", "z", "rx", "ry", "rz"};

std::string heading() {
  std::string text =
      "t,sequence,frame_id,segment,state,completeness,keypoints,matches,inliers,weak_axes,"
      "critical_axes";
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    for (std::size_t j = i; j < kAxes.size(); ++j) {
      text += fmt::format(",cov_{}_{}", kAxes[i], kAxes[j]);
    }
  }
  return text + '\n';
}

}  // namespace

void write_scan_table(const std::filesystem::path& file,
                      std::span<const slam::OdometryEstimate> estimates) {
  std::string text = heading();
  for (const slam::OdometryEstimate& e : estimates) {
    int critical = 0;
    for (const slam::WeakAxis& axis : e.weak_axes) critical += axis.critical ? 1 : 0;
    text += fmt::format("{},{},{},{},{},{:.4f},{},{},{},{},{}", seconds_text(e.stamp), e.sequence,
                        e.frame_id, e.segment, slam::to_string(e.state), e.completeness,
                        e.keypoints, e.matches, e.inliers, e.weak_axes.size(), critical);
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = i; j < 6; ++j) text += fmt::format(",{:.10g}", e.covariance(i, j));
    }
    text += '\n';
  }
  write_text_file(file, text);
}

}  // namespace glint::cli
