// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/motion_estimation.hpp"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint::slam {
namespace {

class RegistrarTest : public testing::Test {
 protected:
  Eigen::Vector3d random_vector(double scale) {
    std::uniform_real_distribution<double> uniform(-scale, scale);
    return {uniform(random_), uniform(random_), uniform(random_)};
  }

  // Pairs that `truth` relates up to gaussian noise, with scores between 0.05 and 1.
  std::vector<PointPair> pairs(int count, double noise_m) {
    std::normal_distribution<double> noise(0.0, noise_m);
    std::uniform_real_distribution<double> score(0.05, 1.0);
    std::vector<PointPair> result;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d x = random_vector(8.0);
      const Eigen::Vector3d e(noise(random_), noise(random_), noise(random_));
      result.push_back({truth_ * x + e, x, score(random_)});
    }
    return result;
  }

  double translation_error_m(const Registration& found) const {
    return (found.T_reference_current.translation_m - truth_.translation_m).norm();
  }
  double rotation_error_rad(const Registration& found) const {
    return so3_log(found.T_reference_current.rotation * truth_.rotation.conjugate()).norm();
  }

  std::mt19937 random_{7};
  const Pose truth_{so3_exp({0.02, -0.03, 0.2}), {0.4, -0.1, 0.05}};
  Registrar registrar_{{}};
};

TEST_F(RegistrarTest, ExactPairsGiveTheExactMotion) {
  const Registration found = registrar_.align(pairs(50, 0.0), Pose{});
  ASSERT_TRUE(found.ok);
  EXPECT_LT(translation_error_m(found), 1e-9);
  EXPECT_LT(rotation_error_rad(found), 1e-9);
  EXPECT_EQ(found.inliers, 50);
}

TEST_F(RegistrarTest, OneGrossOutlierMovesNothing) {
  auto matched = pairs(50, 0.0);
  matched[3].reference_m += Eigen::Vector3d(60.0, -20.0, 5.0);
  matched[3].score = 1.0;
  const Registration found = registrar_.align(matched, Pose{});
  ASSERT_TRUE(found.ok);
  EXPECT_LT(translation_error_m(found), 1e-9);
  EXPECT_EQ(found.inliers, 49);
}

TEST_F(RegistrarTest, HalfOfThePairsMayBeWrong) {
  auto matched = pairs(120, 0.02);
  for (std::size_t i = 0; i < 60; ++i) matched[i].reference_m = random_vector(10.0);
  const Registration found = registrar_.align(matched, Pose{});
  ASSERT_TRUE(found.ok);
  EXPECT_LT(translation_error_m(found), 0.03);
  EXPECT_LT(rotation_error_rad(found), 0.005);
}

TEST_F(RegistrarTest, CovarianceAgreesWithTheScatterOfItsErrors) {
  double normalised = 0.0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto matched = pairs(60, 0.02);
    for (PointPair& pair : matched) pair.score = 1.0;
    const Registration found = registrar_.align(matched, Pose{});
    ASSERT_TRUE(found.ok);
    const Pose error = truth_.inverse() * found.T_reference_current;
    const Twist e = se3_log(error);
    normalised += e.dot(found.covariance.inverse() * e) / 6.0;
  }
  EXPECT_NEAR(normalised / kTrials, 1.0, 0.3);
}

// The same cost as Ceres sees it: an independent solver must agree on the minimum.
struct WeightedDistance {
  template <class T>
  bool operator()(const T* q, const T* t, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> rotation(q);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> translation(t);
    const Eigen::Matrix<T, 3, 1> moved = rotation * pair.current_m.cast<T>() + translation;
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = pair.score * (pair.reference_m.cast<T>() - moved);
    return true;
  }
  PointPair pair;
};

TEST_F(RegistrarTest, AgreesWithAnIndependentSolver) {
  const auto matched = pairs(80, 0.06);
  const RegistrationOptions options{.inlier_m = 10.0};  // every pair takes part in both
  const Registration found = Registrar(options).align(matched, Pose{});
  ASSERT_TRUE(found.ok);
  ASSERT_EQ(found.inliers, 80);

  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  ceres::Problem problem;
  for (const PointPair& pair : matched) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<WeightedDistance, 3, 4, 3>(new WeightedDistance{pair}),
        new ceres::HuberLoss(options.huber_m), q.coeffs().data(), t.data());
  }
  problem.SetManifold(q.coeffs().data(), new ceres::EigenQuaternionManifold);
  ceres::Solver::Options solver;
  solver.function_tolerance = 1e-14;
  solver.gradient_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  EXPECT_LT((found.T_reference_current.translation_m - t).norm(), 1e-6);
  EXPECT_LT(so3_log(found.T_reference_current.rotation * q.conjugate()).norm(), 1e-6);
}

TEST_F(RegistrarTest, TooFewPairsAreRefused) {
  EXPECT_FALSE(registrar_.align({}, Pose{}).ok);
  EXPECT_FALSE(registrar_.align(pairs(5, 0.0), Pose{}).ok);
}

TEST_F(RegistrarTest, PairsOnALineAreRefused) {
  std::vector<PointPair> matched;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d x(0.25 * i, 0.0, 0.0);
    matched.push_back({truth_ * x, x, 1.0});
  }
  EXPECT_FALSE(registrar_.align(matched, truth_).ok);
}

TEST_F(RegistrarTest, RepeatsBitForBit) {
  const auto matched = pairs(100, 0.05);
  const Registration a = registrar_.align(matched, Pose{});
  const Registration b = Registrar({}).align(matched, Pose{});
  EXPECT_EQ(a.T_reference_current.translation_m, b.T_reference_current.translation_m);
  EXPECT_EQ(a.T_reference_current.rotation.coeffs(), b.T_reference_current.rotation.coeffs());
}

TEST(Registrar, APredictionThatIsBorneOutNeedsNoSamples) {
  RegistrationOptions options;
  options.hypotheses = 0;
  options.convincing_share = 0.5;
  Registrar registrar(options);
  const Pose truth{so3_exp({0.02, -0.01, 0.1}), {0.4, -0.1, 0.05}};
  std::vector<PointPair> pairs;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.4 * i;
    const Eigen::Vector3d x_m(6.0 * std::cos(angle), 4.0 * std::sin(angle), 0.05 * i);
    pairs.push_back({truth * x_m, x_m, 1.0});
    if (i % 4 == 0) pairs.back().reference_m.z() += 3.0;
  }
  const Pose near = truth * se3_exp((Twist() << 0.05, -0.03, 0.02, 0.0, 0.0, 0.005).finished());
  const Registration found = registrar.align(pairs, near);
  ASSERT_TRUE(found.ok);
  EXPECT_LT((found.T_reference_current.translation_m - truth.translation_m).norm(), 1e-4);
  EXPECT_FALSE(registrar.align(pairs, {so3_exp({0.0, 0.0, 2.0}), {5.0, 0.0, 0.0}}).ok)
      << "without samples a wrong prediction leads nowhere";
}

}  // namespace
}  // namespace glint::slam
