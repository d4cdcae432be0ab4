// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/pair_consensus.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <random>

namespace glint::slam {
namespace {

constexpr std::size_t kSectors = 8;
// Fits to the inliers, each followed by a new choice of them.
constexpr int kRefits = 4;

class Search {
 public:
  Search(std::span<const PointPair> pairs, const ConsensusOptions& options)
      : pairs_(pairs), options_(options) {
    gates_m_.reserve(pairs.size());
    for (const PointPair& pair : pairs) {
      gates_m_.push_back(options.gate_m + options.gate_share * pair.current_m.norm());
    }
  }

  Consensus run() {
    Consensus best;
    std::size_t most = 0;
    std::mt19937 random(12345);  // The same samples each time.
    const auto size = static_cast<std::uint32_t>(pairs_.size());
    std::vector<PointPair> sample(3);
    for (int hypothesis = 0; hypothesis < options_.hypotheses; ++hypothesis) {
      std::array<std::uint32_t, 3> pick{};
      for (auto& p : pick) p = static_cast<std::uint32_t>(random()) % size;
      if (!rigid(pick)) continue;
      for (std::size_t i = 0; i < 3; ++i) sample[i] = pairs_[pick[i]];
      const Pose pose = weighted_umeyama(sample);
      const std::size_t agreeing = count(pose);
      if (agreeing <= most) continue;
      most = agreeing;
      best.T_reference_current = pose;
    }
    if (most < 3) return {};
    refit(best);
    best.sectors = count_sectors(best.inliers);
    return best;
  }

 private:
  // Whether the sides of the triangle are as long on either side, and it is no line.
  [[nodiscard]] bool rigid(const std::array<std::uint32_t, 3>& pick) const {
    if (pick[0] == pick[1] || pick[1] == pick[2] || pick[0] == pick[2]) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = pick[i];
      const std::uint32_t b = pick[(i + 1) % 3];
      const double reference_m = (pairs_[a].reference_m - pairs_[b].reference_m).norm();
      const double current_m = (pairs_[a].current_m - pairs_[b].current_m).norm();
      if (std::abs(reference_m - current_m) > std::max(gates_m_[a], gates_m_[b])) return false;
    }
    const Eigen::Vector3d ab = pairs_[pick[1]].current_m - pairs_[pick[0]].current_m;
    const Eigen::Vector3d ac = pairs_[pick[2]].current_m - pairs_[pick[0]].current_m;
    const double longest2 = std::max(ab.squaredNorm(), ac.squaredNorm());
    constexpr double kLeastSpread = 0.1;
    return ab.cross(ac).norm() > kLeastSpread * longest2;
  }

  [[nodiscard]] bool agrees(std::size_t i, const Eigen::Matrix3d& rotation,
                            const Eigen::Vector3d& translation_m) const {
    const PointPair& pair = pairs_[i];
    const Eigen::Vector3d e = pair.reference_m - (rotation * pair.current_m + translation_m);
    return e.squaredNorm() < gates_m_[i] * gates_m_[i];
  }

  [[nodiscard]] std::size_t count(const Pose& pose) const {
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    std::size_t agreeing = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (agrees(i, rotation, pose.translation_m)) ++agreeing;
    }
    return agreeing;
  }

  void refit(Consensus& best) const {
    std::size_t before = 0;
    for (int i = 0; i < kRefits; ++i) {
      select(best);
      if (best.inliers.size() < 3 || best.inliers.size() == before) return;
      before = best.inliers.size();
      best.T_reference_current = weighted_umeyama(best.inliers);
    }
    select(best);
  }

  void select(Consensus& best) const {
    const Eigen::Matrix3d rotation = best.T_reference_current.rotation.toRotationMatrix();
    best.inliers.clear();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (agrees(i, rotation, best.T_reference_current.translation_m)) {
        best.inliers.push_back(pairs_[i]);
      }
    }
  }

  static int count_sectors(std::span<const PointPair> inliers) {
    std::bitset<kSectors> seen;
    for (const PointPair& pair : inliers) {
      const double turns = std::atan2(pair.current_m.y(), pair.current_m.x()) / (2.0 * M_PI) + 0.5;
      seen.set(std::min(kSectors - 1, static_cast<std::size_t>(turns * kSectors)));
    }
    return static_cast<int>(seen.count());
  }

  std::span<const PointPair> pairs_;
  const ConsensusOptions options_;
  std::vector<double> gates_m_;
};

}  // namespace

Consensus find_consensus(std::span<const PointPair> pairs, const ConsensusOptions& options) {
  if (pairs.size() < 3) return {};
  return Search(pairs, options).run();
}

}  // namespace glint::slam
