// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/local_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

KdTreeOptions tree_options(const LocalMapOptions& options) {
  KdTreeOptions tree;
  tree.voxel_m = static_cast<float>(options.voxel_m);
  return tree;
}

}  // namespace

LocalMap::LocalMap(LocalMapOptions options)
    : options_(options), ground_(tree_options(options)), general_(tree_options(options)) {}

void LocalMap::associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                         const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) const {
  terms.clear();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const bool ground = i < ground_count;
    const Eigen::Vector3d point_m = points_m[i].cast<double>();
    const Eigen::Vector3d place_m = T_odom_scan * point_m;
    auto term = plane_near(ground ? ground_ : general_, place_m);
    if (!term) continue;
    if (std::abs(term->normal.dot(place_m) - term->offset_m) > options_.largest_residual_m) {
      continue;
    }
    term->point_m = point_m;
    term->weight = ground ? options_.ground_weight : 1.0;
    terms.push_back(*term);
  }
}

std::optional<PlaneTerm> LocalMap::plane_near(const IncKdTree& tree,
                                              const Eigen::Vector3d& place_m) const {
  // More than three, for the third may lie in line with the first two.
  const bool span = options_.neighbours <= 3;
  const Neighbours near = tree.nearest(place_m.cast<float>(), span ? 6 : options_.neighbours,
                                       static_cast<float>(options_.largest_distance_m));
  return span ? spanned(near) : fitted(near);
}

// The plane of the three nearest points that are not in line
// [Du & Beltrame 2023, sec. III-B, scan-to-map].
std::optional<PlaneTerm> LocalMap::spanned(const Neighbours& near) const {
  for (int i = 2; i < near.count; ++i) {
    const Eigen::Vector3d a = near[0].point_m.cast<double>();
    const Eigen::Vector3d ab = near[1].point_m.cast<double>() - a;
    const Eigen::Vector3d ac = near[i].point_m.cast<double>() - a;
    const Eigen::Vector3d cross = ab.cross(ac);
    const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (cross.norm() < options_.least_spread * longest2 || longest2 == 0.0) continue;
    PlaneTerm term;
    term.normal = cross.normalized();
    term.offset_m = term.normal.dot(a);
    return term;
  }
  return std::nullopt;
}

std::optional<PlaneTerm> LocalMap::fitted(const Neighbours& near) const {
  if (near.count < options_.neighbours) return std::nullopt;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < near.count; ++i) mean += near[i].point_m.cast<double>();
  mean /= near.count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < near.count; ++i) {
    const Eigen::Vector3d d = near[i].point_m.cast<double>() - mean;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance);
  PlaneTerm term;
  term.normal = eigen.eigenvectors().col(0).normalized();
  term.offset_m = term.normal.dot(mean);
  for (int i = 0; i < near.count; ++i) {
    const double misfit_m = term.normal.dot(near[i].point_m.cast<double>()) - term.offset_m;
    if (std::abs(misfit_m) > options_.largest_misfit_m) return std::nullopt;
  }
  // Points in line fit any plane around them.
  if (eigen.eigenvalues()(1) <
      options_.least_spread * options_.least_spread * eigen.eigenvalues()(2)) {
    return std::nullopt;
  }
  return term;
}

void LocalMap::add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                   const Pose& T_odom_scan) {
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3f place_m = (T_odom_scan * points_m[i].cast<double>()).cast<float>();
    (i < ground_count ? ground_ : general_).insert_downsampled(place_m);
  }
  // Not with every scan: letting go looks at the whole tree.
  const Eigen::Vector3d& here_m = T_odom_scan.translation_m;
  if (!kept_around_m_) kept_around_m_ = here_m;
  if ((here_m - *kept_around_m_).norm() < 0.1 * options_.radius_m) return;
  kept_around_m_ = here_m;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(options_.radius_m);
  const Box box{(here_m - reach).cast<float>(), (here_m + reach).cast<float>()};
  ground_.keep(box);
  general_.keep(box);
}

void LocalMap::clear() {
  ground_.clear();
  general_.clear();
  kept_around_m_.reset();
}

std::optional<LocalMap::Rebuild> LocalMap::take_rebuild() {
  for (const bool of_ground : {false, true}) {
    auto tree = (of_ground ? ground_ : general_).take_rebuild();
    if (tree) return Rebuild{of_ground, std::move(*tree)};
  }
  return std::nullopt;
}

void LocalMap::adopt(Rebuild&& rebuild) {
  Rebuild taken = std::move(rebuild);
  (taken.of_ground ? ground_ : general_).adopt(std::move(taken.tree));
}

}  // namespace glint::slam
