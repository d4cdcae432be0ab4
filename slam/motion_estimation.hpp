// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// A matched pair of 3-D points: Y_n of the reference scan, X_n of the current one, and S_n.
struct PointPair {
  Eigen::Vector3d reference_m;  ///< Y_n, reference frame.
  Eigen::Vector3d current_m;    ///< X_n, current frame.
  double score = 1.0;           ///< S_n, see match_score().
};

struct RegistrationOptions {
  double inlier_m = 0.15;  ///< Pairs farther apart after the robust start are left out.
  double huber_m = 0.1;    ///< Scale of the Huber kernel.
  int min_inliers = 12;
  int hypotheses = 200;  ///< Three-point samples of the robust start.
  /// Nothing is sampled where so large a share of the pairs bears the predicted motion out.
  double convincing_share = 2.0;
  int max_iterations = 20;
};

struct Registration {
  bool ok = false;
  Pose T_reference_current;
  /// Of T_reference_current: translation then rotation, right perturbation, m^2 and rad^2.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  int inliers = 0;
  double rms_m = 0.0;  ///< Of the inliers' distances.
};

/// argmin over R, T of sum_n rho(|(Y_n - (R X_n + T)) S_n|^2) [Du & Beltrame 2023, eqs. 2-3], made
/// robust: the best of three-point samples (and of the predicted motion) chooses the inliers, a
/// Huber kernel tempers the rest. Deterministic. Thread-compatible; buffers are reused.
class Registrar {
 public:
  explicit Registrar(RegistrationOptions options) : options_(options) {}
  /// `predicted` takes part as a hypothesis. Not ok with fewer than min_inliers inliers, or when
  /// these do not fix all six degrees of freedom.
  Registration align(const std::vector<PointPair>& pairs, const Pose& predicted);
  /// The same from a start that is near already: no sampling.
  Registration refine(const std::vector<PointPair>& pairs, const Pose& start);

 private:
  Pose robust_start(const std::vector<PointPair>& pairs, const Pose& predicted);
  Registration solve(Pose pose);
  void select_inliers(const std::vector<PointPair>& pairs, const Pose& pose);

  RegistrationOptions options_;
  std::vector<PointPair> inliers_;
};

/// The rigid motion that takes `current_m` to `reference_m` with the least sum of
/// weight * squared distance, weight = score^2 [Umeyama 1991, without scale].
Pose weighted_umeyama(const std::vector<PointPair>& pairs);

}  // namespace glint::slam
