// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/gravity_estimate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

// Long enough that odometry's jitter, seen as an acceleration, is far below what is to be told.
constexpr double kWindow_s = 8.0;
constexpr double kShortest_s = 4.0;
constexpr std::size_t kFewestScans = 16;
// Of 20 scans a second, with room to spare.
constexpr std::size_t kMostScans = 256;
constexpr double kWeight_mps2 = 9.80665;
// What accelerometers that are of use are off by.
constexpr double kLargestMisfit_mps2 = 0.7;
// Odometry's own errors over the window, and neighbouring scans that err alike.
constexpr double kLeastSigma_rad = 0.1 * M_PI / 180.0;
constexpr double kErringAlike = 3.0;

}  // namespace

GravityEstimate::GravityEstimate() : nodes_(kMostScans) {}

void GravityEstimate::add(const Pose& T_odom_from, const Pose& T_odom_to, const ImuMotion& felt,
                          double span_s) {
  const bool follows = count_ > 0 && span_s > 0.0 && span_s < 1.0 &&
                       node(0).T_odom_sensor.translation_m == T_odom_from.translation_m &&
                       node(0).T_odom_sensor.rotation.coeffs() == T_odom_from.rotation.coeffs();
  if (!follows) {
    count_ = 0;
    push({.T_odom_sensor = T_odom_from});
  }
  push({T_odom_to, span_s, T_odom_from.rotation * felt.velocity_mps,
        T_odom_from.rotation * felt.way_m});
  forget_old();
}

void GravityEstimate::push(const Node& node) {
  nodes_[next_] = node;
  next_ = (next_ + 1) % nodes_.size();
  count_ = std::min(count_ + 1, nodes_.size());
}

void GravityEstimate::forget_old() {
  double age_s = 0.0;
  std::size_t kept = 1;
  while (kept < count_ && age_s < kWindow_s) age_s += node(kept++ - 1).span_s;
  count_ = kept;
}

// The way less what was felt is a parabola, p + v t + g t^2 / 2, fitted by least squares.
std::optional<FeltGravity> GravityEstimate::felt() const {
  if (count_ < kFewestScans) return std::nullopt;
  double window_s = 0.0;
  for (std::size_t back = 0; back + 1 < count_; ++back) window_s += node(back).span_s;
  if (window_s < kShortest_s) return std::nullopt;

  const Pose& first = node(count_ - 1).T_odom_sensor;
  const Eigen::Quaterniond to_last = node(0).T_odom_sensor.rotation.conjugate();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d right = Eigen::Matrix3d::Zero();  // an axis of space a column
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  double squares_m2 = 0.0;
  double turn_weight = 0.0;
  double t_s = 0.0;
  Eigen::Vector3d felt_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d felt_mps = Eigen::Vector3d::Zero();
  for (std::size_t back = count_; back-- > 0;) {
    const Node& at = node(back);
    if (back + 1 < count_) {
      felt_m += felt_mps * at.span_s + at.way_m;
      felt_mps += at.velocity_mps;
      t_s += at.span_s;
    }
    const double x = t_s - 0.5 * window_s;
    const Eigen::Vector3d basis(1.0, x, 0.5 * x * x);
    const Eigen::Vector3d fall_m = at.T_odom_sensor.translation_m - first.translation_m - felt_m;
    normal += basis * basis.transpose();
    right += basis * fall_m.transpose();
    squares_m2 += fall_m.squaredNorm();
    // A force counts for the fit by when it is felt: most in the middle.
    const double weight = std::pow(t_s * (window_s - t_s), 2.0);
    turn += weight * (to_last * at.T_odom_sensor.rotation).toRotationMatrix();
    turn_weight += weight;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  const Eigen::Matrix3d fit = solver.solve(right);
  const Eigen::Vector3d gravity_mps2 = fit.row(2);
  const double strength_mps2 = gravity_mps2.norm();
  if (!(std::abs(strength_mps2 - kWeight_mps2) < kLargestMisfit_mps2)) return std::nullopt;

  const double misfit_m2 = std::max(0.0, squares_m2 - (fit.transpose() * right).trace());
  const double variance_m2 = misfit_m2 / (3.0 * static_cast<double>(count_ - 3));
  const double variance_mps2 = variance_m2 * solver.solve(Eigen::Matrix3d::Identity())(2, 2);
  return FeltGravity{
      to_last * (-gravity_mps2 / strength_mps2), turn / turn_weight,
      std::hypot(kLeastSigma_rad, kErringAlike * std::sqrt(variance_mps2) / strength_mps2)};
}

}  // namespace glint::slam
