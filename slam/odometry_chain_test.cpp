// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/odometry_chain.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "slam/pose_graph_solver.hpp"

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// A path with turns, whose steps are known differently well.
struct Path {
  explicit Path(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Pose pose;
    for (int i = 0; i < 30; ++i) {
      T_odom.push_back(pose);
      Matrix6 root = Matrix6::Zero();
      for (double& value : root.reshaped()) value = 0.01 * unit(random);
      covariances.emplace_back(root * root.transpose() + 1e-5 * Matrix6::Identity());
      Twist step;
      step << 1.0, 0.2 * unit(random), 0.1 * unit(random), 0.1 * unit(random), 0.1 * unit(random),
          0.5 * unit(random);
      pose = pose * se3_exp(step);
    }
  }
  std::vector<Pose> T_odom;
  std::vector<Matrix6> covariances;
};

TEST(OdometryChain, WithItsEndsWhereOdometryHasThemNothingMoves) {
  const Path path(1);
  const OdometryChain chain(path.T_odom, path.covariances);
  std::vector<Pose> poses(path.T_odom.size());
  const Pose T_map_odom = se3_exp((Twist() << 3, -2, 1, 0.1, 0.2, -0.5).finished());
  poses.front() = T_map_odom * path.T_odom.front();
  poses.back() = T_map_odom * path.T_odom.back();
  chain.spread(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(se3_log((T_map_odom * path.T_odom[i]).inverse() * poses[i]).norm(), 1e-9);
  }
}

TEST(OdometryChain, ACorrectionIsSpreadAsTheWholeGraphWouldHaveIt) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Path path(seed);
    const std::size_t last = path.T_odom.size() - 1;
    const Pose end = path.T_odom.back() *
                     se3_exp((Twist() << 0.05, -0.03, 0.02, 0.004, -0.003, 0.006).finished());

    std::vector<GraphEdge> edges;
    for (std::size_t i = 1; i <= last; ++i) {
      edges.push_back({i - 1, i, path.T_odom[i - 1].inverse() * path.T_odom[i],
                       whitening_of(path.covariances[i])});
    }
    std::vector<Pose> whole = path.T_odom;
    whole.back() = end;
    std::vector<bool> fixed(whole.size());
    fixed.front() = fixed.back() = true;
    solve_pose_graph(whole, fixed, edges);

    std::vector<Pose> spread = path.T_odom;
    spread.back() = end;
    const OdometryChain chain(path.T_odom, path.covariances);
    chain.spread(spread);
    const GraphEdge as_one{0, last, chain.edge(), whitening_of(chain.covariance())};
    double sum = 0.0;
    for (const GraphEdge& edge : edges) sum += chi_squared(edge, whole);
    EXPECT_NEAR(chi_squared(as_one, whole), sum, 0.02 * sum) << "one edge says what all say";
    for (std::size_t i = 0; i <= last; ++i) {
      const Twist apart = se3_log(whole[i].inverse() * spread[i]);
      EXPECT_LT(apart.head<3>().norm(), 1e-3);
      EXPECT_LT(apart.tail<3>().norm(), 2e-4);
    }
  }
}

}  // namespace
}  // namespace glint::slam
