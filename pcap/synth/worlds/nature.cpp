// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <array>
#include <cmath>
#include <numbers>

#include "pcap/synth/worlds/things.hpp"

namespace glint::synth {
namespace {

Eigen::Vector3d unit_vector(Random& random) {
  const double z = random.uniform(-1.0, 1.0);
  const double angle_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle_rad), r * std::sin(angle_rad), z};
}

// Corners and faces of a regular icosahedron.
constexpr double kGolden = std::numbers::phi;
const std::array<Eigen::Vector3d, 12> kCorners = {{{-1, kGolden, 0},
                                                   {1, kGolden, 0},
                                                   {-1, -kGolden, 0},
                                                   {1, -kGolden, 0},
                                                   {0, -1, kGolden},
                                                   {0, 1, kGolden},
                                                   {0, -1, -kGolden},
                                                   {0, 1, -kGolden},
                                                   {kGolden, 0, -1},
                                                   {kGolden, 0, 1},
                                                   {-kGolden, 0, -1},
                                                   {-kGolden, 0, 1}}};
constexpr std::array<std::array<std::size_t, 3>, 20> kFaces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

}  // namespace

BodyPtr tree(WorldBuilder& builder, double clear_m) {
  Random& random = builder.random();
  const Look bark{builder.material(Material::kBark, random.below(3)), kSunShade};
  const Look leaves{builder.material(Material::kLeaves, random.below(3)), kSunShade};
  const double radius_m = random.uniform(1.2, 2.1);
  const double half_height_m = random.uniform(1.2, 2.2);
  const double middle_m = clear_m + half_height_m + 0.5;
  Surfaces surfaces;
  add(surfaces,
      Cylinder{Eigen::Vector3d(0.0, 0.0, -0.5), random.uniform(0.11, 0.26), middle_m + 0.5}, bark);
  const int clusters = 60 + random.below(45);
  for (int i = 0; i < clusters; ++i) {
    // More of them outside, where the light is.
    const Eigen::Vector3d place_m =
        (std::cbrt(random.uniform(0.1, 1.0)) * unit_vector(random))
            .cwiseProduct(Eigen::Vector3d(radius_m, radius_m, half_height_m)) +
        middle_m * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d u_axis = unit_vector(random);
    const Eigen::Vector3d v_axis = u_axis.cross(unit_vector(random)).normalized();
    const double width_m = random.uniform(0.25, 0.75);
    const double height_m = random.uniform(0.2, 0.6);
    add(surfaces,
        Rectangle{place_m - 0.5 * (width_m * u_axis + height_m * v_axis), u_axis, v_axis, width_m,
                  height_m},
        leaves);
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

BodyPtr rock(WorldBuilder& builder) {
  Random& random = builder.random();
  const Look look{builder.material(Material::kRock, random.below(2)), kSunlight};
  const Eigen::Vector3d size_m(random.uniform(0.2, 0.75), random.uniform(0.2, 0.6),
                               random.uniform(0.2, 0.7));
  std::array<Eigen::Vector3d, kCorners.size()> corners_m;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    corners_m[i] = random.uniform(0.75, 1.2) * kCorners[i].normalized().cwiseProduct(size_m);
    corners_m[i].z() += 0.4 * size_m.z();
  }
  Surfaces surfaces;
  for (const auto& face : kFaces) {
    add_triangle(surfaces, corners_m[face[0]], corners_m[face[1]], corners_m[face[2]], look);
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

}  // namespace glint::synth
