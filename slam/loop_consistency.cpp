// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loop_consistency.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Over longer ways odometry may have slipped somewhere, which is no fault of the loops.
constexpr double kLongestWay_m = 50.0;

Matrix6 carried_along(const Pose& motion, const Matrix6& covariance) {
  const Matrix6 by = adjoint(motion);
  return by * covariance * by.transpose();
}

// Of T_from_to; large where the edge says nothing.
Matrix6 covariance_of(const GraphEdge& edge) {
  return (edge.whitening.transpose() * edge.whitening).inverse();
}

// The loops that hang together by contradictions, each with its own.
std::vector<std::vector<std::size_t>> quarrels(std::span<const LoopVote> loops) {
  std::vector<std::vector<std::size_t>> found;
  std::vector<bool> seen(loops.size(), false);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (seen[i] || loops[i].against.empty()) continue;
    std::vector<std::size_t>& members = found.emplace_back(1, i);
    seen[i] = true;
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (const std::size_t other : loops[members[k]].against) {
        if (!seen[other]) members.push_back(other);
        seen[other] = true;
      }
    }
    std::ranges::sort(members);
  }
  return found;
}

// The set of `members` that greed finds, settled ones first and older ones before newer.
std::vector<std::size_t> greedy_set(std::span<const LoopVote> loops,
                                    std::vector<std::size_t> members) {
  std::vector<bool> open(loops.size(), false);
  for (const std::size_t i : members) open[i] = true;
  std::vector<std::size_t> kept;
  while (!members.empty()) {
    const auto contradictions = [&](std::size_t i) {
      return std::make_pair(
          std::ranges::count_if(loops[i].against, [&](std::size_t other) { return open[other]; }),
          loops[i].settled ? 0 : 1);
    };
    const std::size_t best = *std::ranges::min_element(members, {}, contradictions);
    kept.push_back(best);
    open[best] = false;
    for (const std::size_t other : loops[best].against) open[other] = false;
    std::erase_if(members, [&](std::size_t i) { return !open[i]; });
  }
  return kept;
}

// A set that has no more members than those that it would throw out is not worth moving the map.
bool overthrows(std::span<const LoopVote> loops, std::span<const std::size_t> members,
                std::span<const std::size_t> chosen) {
  const auto is_settled = [&](std::size_t i) { return loops[i].settled; };
  const auto settled = std::ranges::count_if(members, is_settled);
  const bool all_stay = std::ranges::count_if(chosen, is_settled) == settled;
  return !all_stay && std::cmp_greater(chosen.size(), settled);
}

// The settled ones, and of the new ones those that contradict neither them nor each other.
std::vector<std::size_t> upheld(std::span<const LoopVote> loops,
                                std::span<const std::size_t> members) {
  std::vector<std::size_t> kept;
  std::vector<std::size_t> fresh;
  for (const std::size_t i : members) {
    const bool doubted = std::ranges::any_of(
        loops[i].against, [&](std::size_t other) { return loops[other].settled; });
    if (loops[i].settled) {
      kept.push_back(i);
    } else if (!doubted && !loops[i].set_aside) {
      fresh.push_back(i);
    }
  }
  const std::vector<std::size_t> added = greedy_set(loops, fresh);
  kept.insert(kept.end(), added.begin(), added.end());
  return kept;
}

}  // namespace

void LoopConsistency::add(const GraphNode& node, const Matrix6& step_covariance) {
  Station station{node.segment, 0.0, node.T_odom_sensor};
  if (!stations_.empty() && stations_.back().segment == node.segment) {
    const Station& last = stations_.back();
    const Eigen::Vector3d way_m =
        node.T_odom_sensor.translation_m - last.T_odom_sensor.translation_m;
    station.path_m = last.path_m + way_m.norm();
    station.covariance = last.covariance + carried_along(node.T_odom_sensor, step_covariance);
  }
  stations_.push_back(station);
}

bool LoopConsistency::near(std::size_t a, std::size_t b) const {
  return stations_[a].segment == stations_[b].segment &&
         std::abs(stations_[a].path_m - stations_[b].path_m) < kLongestWay_m;
}

// Left perturbation, odometry frame.
Matrix6 LoopConsistency::covariance_between(std::size_t a, std::size_t b) const {
  return stations_[std::max(a, b)].covariance - stations_[std::min(a, b)].covariance;
}

// What `b` says of the older keyframe of `a` and the newer one: over to its own older one, along
// it, and back.
bool LoopConsistency::contradict(const GraphEdge& a, const GraphEdge& b) const {
  if (!near(a.from, b.from) || !near(a.to, b.to)) return false;
  const Pose& a_from = stations_[a.from].T_odom_sensor;
  const Pose& a_to = stations_[a.to].T_odom_sensor;
  const Pose T_bto_ato = stations_[b.to].T_odom_sensor.inverse() * a_to;
  const Pose T_afrom_bfrom = a_from.inverse() * stations_[b.from].T_odom_sensor;
  const Pose T_from_to = T_afrom_bfrom * b.T_from_to * T_bto_ato;
  // All as right perturbations of where `a` ends.
  Matrix6 covariance = covariance_of(a) + carried_along(T_bto_ato.inverse(), covariance_of(b));
  covariance += carried_along(a_to.inverse(), covariance_between(a.to, b.to));
  covariance +=
      carried_along(T_from_to.inverse() * a_from.inverse(), covariance_between(a.from, b.from));
  const Twist off = se3_log(a.T_from_to.inverse() * T_from_to);
  const double chi_squared = off.dot(covariance.ldlt().solve(off));
  return chi_squared > kLargestChiSquared;
}

std::vector<bool> largest_agreeing(std::span<const LoopVote> loops) {
  std::vector<bool> kept;
  kept.reserve(loops.size());
  for (const LoopVote& loop : loops) kept.push_back(!loop.set_aside);
  for (const std::vector<std::size_t>& members : quarrels(loops)) {
    std::vector<std::size_t> chosen = greedy_set(loops, members);
    if (!overthrows(loops, members, chosen)) chosen = upheld(loops, members);
    for (const std::size_t i : members) kept[i] = false;
    for (const std::size_t i : chosen) kept[i] = true;
  }
  return kept;
}

}  // namespace glint::slam
