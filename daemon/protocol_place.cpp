// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace glint::daemon {
namespace {

constexpr double kFarthest_m = 1e6;
constexpr double kUsualSigma_m = 3.0;
constexpr double kMostSigma_m = 1000.0;
// By how much a quaternion's length may differ from 1: as rounding in text may make it.
constexpr double kLengthOff = 0.01;

// So many numbers; null when absent.
std::optional<std::vector<double>> numbers_param(const Json& params, const char* name,
                                                 std::size_t count) {
  const Json* value = find_param(params, name);
  if (value == nullptr) return std::nullopt;
  const auto is_number = [](const Json& item) {
    return item.is_number() && std::abs(item.get<double>()) <= kFarthest_m;
  };
  if (!value->is_array() || value->size() != count || !std::ranges::all_of(*value, is_number)) {
    throw RpcError(kInvalidParams, fmt::format("{} must be a list of {} numbers", name, count),
                   name);
  }
  return value->get<std::vector<double>>();
}

Eigen::Quaterniond rotation_of(const double* q_xyzw, const char* name) {
  const Eigen::Quaterniond q(q_xyzw[3], q_xyzw[0], q_xyzw[1], q_xyzw[2]);
  if (std::abs(q.norm() - 1.0) > kLengthOff) {
    throw RpcError(kInvalidParams,
                   fmt::format("the quaternion of {} (x, y, z, w) must have length 1", name), name);
  }
  return q.normalized();
}

}  // namespace

slam::PlaceGuess parse_place_guess(const Json& params, const Pose& T_base_sensor) {
  slam::PlaceGuess guess;
  Pose& pose = guess.T_map_sensor;
  if (const auto whole = numbers_param(params, "T", 7)) {
    pose.translation_m = Eigen::Map<const Eigen::Vector3d>(whole->data());
    pose.rotation = rotation_of(whole->data() + 3, "T");
  } else if (const auto p_m = numbers_param(params, "p_m", 3)) {
    pose.translation_m = Eigen::Map<const Eigen::Vector3d>(p_m->data());
    const auto q = numbers_param(params, "q_xyzw", 4);
    guess.knows_heading = q.has_value();
    if (q) pose.rotation = rotation_of(q->data(), "q_xyzw");
  } else {
    throw RpcError(kInvalidParams, "p_m must be the position in frame map: [x, y, z]", "p_m");
  }
  if (choice_param(params, "child", "sensor|base") == "base") pose = pose * T_base_sensor;
  guess.sigma_m = number_param(params, "sigma_m", kUsualSigma_m, 0.0, kMostSigma_m);
  return guess;
}

}  // namespace glint::daemon
