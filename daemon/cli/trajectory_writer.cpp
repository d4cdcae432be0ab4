// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/trajectory_writer.hpp"

#include <fmt/format.h>

#include <limits>

#include "daemon/cli/text_file.hpp"

namespace glint::cli {
namespace {

// Calls `write` for each pose whose time is after that of the one before.
template <class Write>
void for_each_rising(std::span<const StampedPose> poses, Write write) {
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (const StampedPose& pose : poses) {
    if (pose.stamp.ns <= last_ns) continue;
    last_ns = pose.stamp.ns;
    write(pose);
  }
}

}  // namespace

std::string seconds_text(SensorTime stamp) {
  const std::int64_t seconds = stamp.ns / kNsPerSecond;
  const std::int64_t rest_ns = stamp.ns % kNsPerSecond;
  if (stamp.ns < 0) return fmt::format("-{}.{:09}", -seconds, -rest_ns);
  return fmt::format("{}.{:09}", seconds, rest_ns);
}

std::size_t count_not_rising(std::span<const StampedPose> poses) {
  std::size_t rising = 0;
  for_each_rising(poses, [&](const StampedPose&) { ++rising; });
  return poses.size() - rising;
}

void write_tum(const std::filesystem::path& file, std::span<const StampedPose> poses) {
  std::string text;
  for_each_rising(poses, [&](const StampedPose& pose) {
    const auto& t = pose.T_frame_sensor.translation_m;
    const auto& q = pose.T_frame_sensor.rotation;
    text += fmt::format("{} {} {} {} {} {} {} {}\n", seconds_text(pose.stamp), t.x(), t.y(), t.z(),
                        q.x(), q.y(), q.z(), q.w());
  });
  write_text_file(file, text);
}

void write_kitti(const std::filesystem::path& file, const std::filesystem::path& times_file,
                 std::span<const StampedPose> poses) {
  std::string matrices;
  std::string times;
  for_each_rising(poses, [&](const StampedPose& pose) {
    const Eigen::Matrix3d r = pose.T_frame_sensor.rotation.toRotationMatrix();
    const auto& t = pose.T_frame_sensor.translation_m;
    for (int row = 0; row < 3; ++row) {
      matrices += fmt::format("{} {} {} {}{}", r(row, 0), r(row, 1), r(row, 2), t(row),
                              row < 2 ? ' ' : '\n');
    }
    times += seconds_text(pose.stamp) + '\n';
  });
  write_text_file(file, matrices);
  write_text_file(times_file, times);
}

}  // namespace glint::cli
