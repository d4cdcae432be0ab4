// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/trajectory_error.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

constexpr std::int64_t kHeld_ns = 150'000'000;

// "1317000000.099999905" to nanoseconds without passing through a double, which cannot hold them.
std::optional<SensorTime> parse_seconds(const std::string& text) {
  const std::size_t dot = text.find('.');
  std::string fraction = dot == std::string::npos ? "" : text.substr(dot + 1);
  fraction.resize(9, '0');
  const std::string digits = text.substr(0, dot) + fraction;
  SensorTime time;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), time.ns);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return time;
}

// Position of the truth at a time, linear between its poses; null outside.
std::optional<Eigen::Vector3d> position_at(std::span<const StampedPose> truth, SensorTime t) {
  if (t.ns < truth.front().stamp.ns - kHeld_ns || t.ns > truth.back().stamp.ns + kHeld_ns) {
    return std::nullopt;
  }
  const auto after =
      std::upper_bound(truth.begin(), truth.end(), t,
                       [](SensorTime time, const StampedPose& pose) { return time < pose.stamp; });
  if (after == truth.begin()) return truth.front().T_frame_sensor.translation_m;
  if (after == truth.end()) return truth.back().T_frame_sensor.translation_m;
  const StampedPose& a = *(after - 1);
  const StampedPose& b = *after;
  const double u = static_cast<double>(t - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return a.T_frame_sensor.translation_m +
         u * (b.T_frame_sensor.translation_m - a.T_frame_sensor.translation_m);
}

// Length of the path, from points at least 0.2 s apart: the bob of a gait is no distance.
double path_length_m(std::span<const StampedPose> truth) {
  double length_m = 0.0;
  const StampedPose* last = &truth.front();
  for (const StampedPose& pose : truth) {
    if (pose.stamp - last->stamp < kNsPerSecond / 5 && &pose != &truth.back()) continue;
    length_m += (pose.T_frame_sensor.translation_m - last->T_frame_sensor.translation_m).norm();
    last = &pose;
  }
  return length_m;
}

}  // namespace

std::vector<StampedPose> read_tum(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw InputError(
        fmt::format("cannot read the trajectory {}; is the path right?", file.string()));
  }
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    std::string seconds;
    StampedPose pose;
    auto& t = pose.T_frame_sensor.translation_m;
    auto& q = pose.T_frame_sensor.rotation;
    fields >> seconds >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    const auto stamp = parse_seconds(seconds);
    if (!fields || !stamp || q.norm() < 0.5) {
      throw InputError(fmt::format("{} line {}: not 't x y z qx qy qz qw'; is it a TUM trajectory?",
                                   file.string(), number));
    }
    q.normalize();
    pose.stamp = *stamp;
    if (poses.empty() || poses.back().stamp < pose.stamp) poses.push_back(pose);
  }
  return poses;
}

std::optional<TrajectoryError> trajectory_error(std::span<const StampedPose> estimate,
                                                std::span<const StampedPose> truth) {
  if (truth.size() < 2) return std::nullopt;
  std::vector<Eigen::Vector3d> estimated;
  std::vector<Eigen::Vector3d> expected;
  for (const StampedPose& pose : estimate) {
    const auto position = position_at(truth, pose.stamp);
    if (!position) continue;
    estimated.push_back(pose.T_frame_sensor.translation_m);
    expected.push_back(*position);
  }
  if (estimated.size() < 3) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(estimated.size());
  const Eigen::Map<const Eigen::Matrix3Xd> from(estimated.front().data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> to(expected.front().data(), 3, count);
  const Eigen::Matrix4d alignment = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd error = ((alignment.topLeftCorner<3, 3>() * from).colwise() +
                                  alignment.topRightCorner<3, 1>().col(0)) -
                                 to;
  TrajectoryError result;
  result.ate_rmse_m = std::sqrt(error.colwise().squaredNorm().mean());
  result.ate_max_m = std::sqrt(error.colwise().squaredNorm().maxCoeff());
  result.path_m = path_length_m(truth);
  result.poses = estimated.size();
  return result;
}

}  // namespace glint::cli
