// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/local_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

// Distances are in single precision.
constexpr float kRounding_m = 1e-4F;

KdTreeOptions tree_options(const LocalMapOptions& options) {
  KdTreeOptions tree;
  tree.voxel_m = static_cast<float>(options.voxel_m);
  return tree;
}

}  // namespace

LocalMap::LocalMap(LocalMapOptions options)
    : options_(options), ground_(tree_options(options)), general_(tree_options(options)) {}

void LocalMap::associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                         const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) {
  terms.clear();
  lookups_.resize(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d place_m = T_odom_scan * points_m[i].cast<double>();
    Lookup& lookup = lookups_[i];
    lookup.place_m = place_m.cast<float>();
    lookup.near = tree_of(i < ground_count)
                      .nearest(lookup.place_m, kMaxNeighbours,
                               static_cast<float>(options_.largest_distance_m));
    Neighbours near = lookup.near;
    near.count = std::min(near.count, neighbours_wanted());
    add_term(points_m[i], i < ground_count, place_m, near, terms);
  }
}

void LocalMap::associate_again(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                               const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) {
  terms.clear();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d place_m = T_odom_scan * points_m[i].cast<double>();
    const Neighbours near =
        near_again(lookups_[i], tree_of(i < ground_count), place_m.cast<float>());
    add_term(points_m[i], i < ground_count, place_m, near, terms);
  }
}

// Points that were not among the nearest then are no nearer now than their least distance then,
// less the way between the two places.
Neighbours LocalMap::near_again(const Lookup& lookup, const IncKdTree& tree,
                                const Eigen::Vector3f& place_m) const {
  const auto largest_m = static_cast<float>(options_.largest_distance_m);
  const int wanted = neighbours_wanted();
  const Neighbours& then = lookup.near;
  const bool full = then.count == kMaxNeighbours;
  const float others_m = (full ? std::sqrt(then[then.count - 1].squared_distance_m2) : largest_m) -
                         (place_m - lookup.place_m).norm() - kRounding_m;
  Neighbours near;
  float limit_m2 = largest_m * largest_m;
  for (int i = 0; i < then.count; ++i) {
    const Eigen::Vector3f& point_m = then[i].point_m;
    near.offer(point_m, (point_m - place_m).squaredNorm(), wanted, limit_m2);
  }
  if (near.count == wanted && others_m > 0 && limit_m2 < others_m * others_m) return near;
  return tree.nearest(place_m, wanted, largest_m);
}

// More than three, for the third may lie in line with the first two.
int LocalMap::neighbours_wanted() const {
  return options_.neighbours <= 3 ? 6 : options_.neighbours;
}

void LocalMap::add_term(const Eigen::Vector3f& point_m, bool ground, const Eigen::Vector3d& place_m,
                        const Neighbours& near, std::vector<PlaneTerm>& terms) const {
  auto term = options_.neighbours <= 3 ? spanned(near) : fitted(near);
  if (!term) return;
  if (std::abs(term->normal.dot(place_m) - term->offset_m) > options_.largest_residual_m) return;
  term->point_m = point_m.cast<double>();
  term->weight = ground ? options_.ground_weight : 1.0;
  terms.push_back(*term);
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
