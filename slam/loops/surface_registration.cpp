// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/surface_registration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Gates of the rounds; the last one goes on until the scan stays where it is.
constexpr std::array kGates_m = {1.0, 0.6, 0.3, 0.3, 0.3};
constexpr double kSettled_m = 0.002;
constexpr double kSettled_rad = 0.0002;
constexpr std::size_t kFewestTerms = 50;
// A normal says something along an axis when it lies within 60 degrees of it. Fewer than so many
// of them, or too small a share, leave the axis open.
constexpr double kAligned = 0.5;
constexpr double kFewestAligned = 25.0;
// Neighbouring points err alike, so that a good many of them count as one measurement.
constexpr double kPointsPerMeasurement = 10.0;
// Of a distance to a surface and of a keypoint, at least.
constexpr double kSurfaceSigma_m = 0.03;
constexpr double kKeypointSigma_m = 0.1;
// Holds the scan where it is along what nothing fixes, and moves it nowhere else.
constexpr double kAnchorWeight = 1e-3;
// What a scan's own points are off by together: the sensor swayed while it was taken.
constexpr double kOwnSigma_m = 0.01;
constexpr double kOwnSigma_rad = 0.007;
// What is known without looking: a place is no farther off than this.
constexpr double kOpenSigma_m = 30.0;
constexpr double kOpenSigma_rad = 1.0;

class Registrator {
 public:
  Registrator(SurfaceMap& map, std::span<const Eigen::Vector3f> points_m,
              std::span<const PointTerm> keypoints, const Pose& start, double least_aligned)
      : map_(map),
        points_m_(points_m),
        keypoints_(keypoints.begin(), keypoints.end()),
        pose_(start),
        least_aligned_(least_aligned) {
    keypoints_.push_back({Eigen::Vector3d::Zero(), start.translation_m, kAnchorWeight});
  }

  SurfaceRegistration run() {
    SurfaceRegistration outcome;
    for (const double gate_m : kGates_m) {
      associate(gate_m);
      outcome.weak_axes = strip_weak_axes();
      if (terms_.size() < kFewestTerms) return outcome;
      keypoints_.back().fixed_m = pose_.translation_m;
      joint_ = optimize_jointly(pose_, {terms_, keypoints_});
      if (!joint_.ok) return outcome;
      const Pose step = pose_.inverse() * joint_.T_odom_scan;
      pose_ = joint_.T_odom_scan;
      if (gate_m == kGates_m.back() && step.translation_m.norm() < kSettled_m &&
          so3_log(step.rotation).norm() < kSettled_rad) {
        break;
      }
    }
    outcome.T_map_scan = pose_;
    judge(outcome);
    outcome.ok = outcome.covariance.allFinite();
    return outcome;
  }

 private:
  void associate(double gate_m) {
    terms_.clear();
    for (const Eigen::Vector3f& scan_point_m : points_m_) {
      const Eigen::Vector3d point_m = scan_point_m.cast<double>();
      const Eigen::Vector3d place_m = pose_ * point_m;
      const auto plane = map_.plane_near(place_m);
      if (!plane) continue;
      PlaneTerm term;
      term.normal = plane->normal;
      term.offset_m = plane->normal.dot(plane->middle_m);
      if (std::abs(term.normal.dot(place_m) - term.offset_m) > gate_m) continue;
      term.point_m = point_m;
      terms_.push_back(term);
    }
  }

  // Takes from the terms what their normals have along weak axes, so that they say nothing there.
  int strip_weak_axes() {
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
    for (const PlaneTerm& term : terms_) normals += term.normal * term.normal.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normals);
    const double least =
        std::max(kFewestAligned, least_aligned_ * static_cast<double>(terms_.size()));
    int weak = 0;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = eigen.eigenvectors().col(i);
      double aligned = 0.0;
      for (const PlaneTerm& term : terms_) {
        const double along = std::abs(term.normal.dot(axis));
        if (along > kAligned) aligned += along;
      }
      if (aligned >= least) continue;
      ++weak;
      std::erase_if(terms_, [&](const PlaneTerm& term) {
        return std::abs(term.normal.dot(axis)) > kAligned;
      });
      for (PlaneTerm& term : terms_) strip(term, axis);
    }
    return weak;
  }

  // The distance of the point stays what it is where the scan now lies.
  void strip(PlaneTerm& term, const Eigen::Vector3d& axis) const {
    const double distance_m = term.normal.dot(pose_ * term.point_m) - term.offset_m;
    term.normal = (term.normal - term.normal.dot(axis) * axis).normalized();
    term.offset_m = term.normal.dot(pose_ * term.point_m) - distance_m;
  }

  void judge(SurfaceRegistration& outcome) {
    associate(kGates_m.back());
    double squares_m2 = 0.0;
    for (const PlaneTerm& term : terms_) {
      const double e = term.normal.dot(pose_ * term.point_m) - term.offset_m;
      squares_m2 += e * e;
    }
    const auto count = static_cast<double>(terms_.size());
    outcome.overlap = count / static_cast<double>(std::max<std::size_t>(1, points_m_.size()));
    outcome.rms_m = std::sqrt(squares_m2 / std::max(1.0, count));
    const auto variance = [](double sigma, double least) {
      return std::max(sigma * sigma, least * least);
    };
    Twist open;
    open.head<3>().setConstant(1.0 / (kOpenSigma_m * kOpenSigma_m));
    open.tail<3>().setConstant(1.0 / (kOpenSigma_rad * kOpenSigma_rad));
    Matrix6 keypoint_hessian = joint_.point_hessian;
    keypoint_hessian.diagonal().head<3>().array() -= kAnchorWeight;
    const Matrix6 information =
        joint_.plane_hessian /
            (kPointsPerMeasurement * variance(joint_.plane_rms_m, kSurfaceSigma_m)) +
        keypoint_hessian / (kKeypointWeight * variance(joint_.point_rms_m, kKeypointSigma_m)) +
        Matrix6(open.asDiagonal());
    Twist own;
    own.head<3>().setConstant(kOwnSigma_m * kOwnSigma_m);
    own.tail<3>().setConstant(kOwnSigma_rad * kOwnSigma_rad);
    outcome.covariance = information.inverse() + Matrix6(own.asDiagonal());
  }

  SurfaceMap& map_;
  std::span<const Eigen::Vector3f> points_m_;
  std::vector<PointTerm> keypoints_;  ///< And the anchor.
  Pose pose_;
  const double least_aligned_;
  std::vector<PlaneTerm> terms_;
  JointResult joint_;
};

}  // namespace

SurfaceRegistration register_on_surfaces(SurfaceMap& map, std::span<const Eigen::Vector3f> points_m,
                                         std::span<const PointTerm> keypoints, const Pose& start,
                                         double least_aligned) {
  return Registrator(map, points_m, keypoints, start, least_aligned).run();
}

}  // namespace glint::slam
