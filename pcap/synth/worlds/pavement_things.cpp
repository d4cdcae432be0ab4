// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/worlds/things.hpp"

namespace glint::synth {

BodyPtr person(WorldBuilder& builder) {
  Random& random = builder.random();
  const double scale = random.uniform(0.88, 1.1);
  const Look coat{builder.material(Material::kCloth, random.below(5)), kSunShade};
  const Look trousers{builder.material(Material::kCloth, random.below(5)), kSunShade};
  const Look skin{plain(random.uniform(0.3, 0.6)), kSunShade};
  Surfaces surfaces;
  // Legs in mid-stride, one ahead.
  const double stride_m = random.uniform(0.05, 0.18);
  const auto limb = [&](double x, double y, double z, double radius_m, double height_m,
                        const Look& look) {
    add(surfaces, Cylinder{scale * Eigen::Vector3d(x, y, z), scale * radius_m, scale * height_m},
        look);
  };
  limb(stride_m, 0.1, 0.0, 0.08, 0.85, trousers);
  limb(-stride_m, -0.1, 0.0, 0.08, 0.85, trousers);
  limb(-stride_m, 0.25, 0.75, 0.05, 0.65, coat);
  limb(stride_m, -0.25, 0.75, 0.05, 0.65, coat);
  limb(0.0, 0.0, 1.45, 0.1, 0.28, skin);
  add_box(surfaces, {0.0, 0.0, 0.8 * scale}, scale * Eigen::Vector3d(0.24, 0.4, 0.65), 0.0, coat);
  if (random.chance(0.4)) {
    const Look bag{builder.material(Material::kCloth, 5), kSunShade};
    add_box(surfaces, {-0.2 * scale, 0.0, 0.95 * scale}, {0.16, 0.3, 0.42}, 0.0, bag);
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

BodyPtr lamp_pole(WorldBuilder& builder) {
  Random& random = builder.random();
  const Look metal{builder.material(Material::kMetal), kSunShade};
  const double height_m = random.uniform(5.0, 7.0);
  const double arm_m = random.uniform(0.8, 1.6);
  Surfaces surfaces;
  add(surfaces, Cylinder{Eigen::Vector3d::Zero(), random.uniform(0.06, 0.1), height_m}, metal);
  add(surfaces, Cylinder{Eigen::Vector3d::Zero(), 0.14, 0.6}, metal);
  add_box(surfaces, {0.5 * arm_m, 0.0, height_m}, {arm_m, 0.08, 0.08}, 0.0, metal);
  add_box(surfaces, {arm_m, 0.0, height_m - 0.08}, {0.6, 0.25, 0.14}, 0.0, {plain(0.7), kSunShade});
  if (random.chance(0.4)) {
    // A bill stuck to it.
    const Rectangle board = upright({0.11, -0.25, 1.2}, {0.11, 0.25, 1.2}, 0.7);
    add(surfaces, board, {poster(0.5, 0.7, builder.photographs(), random), kSunShade});
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

BodyPtr sign_pole(WorldBuilder& builder) {
  Random& random = builder.random();
  const double size_m = random.uniform(0.55, 0.75);
  const double low_m = random.uniform(2.25, 2.45);
  Surfaces surfaces;
  add(surfaces, Cylinder{Eigen::Vector3d::Zero(), 0.035, low_m + size_m},
      {builder.material(Material::kMetal), kSunShade});
  const Rectangle plate =
      upright({0.04, -0.5 * size_m, low_m}, {0.04, 0.5 * size_m, low_m}, size_m);
  add(surfaces, plate, {sign(size_m, size_m, random), kSunShade});
  if (random.chance(0.4)) {
    const Rectangle below = upright({0.04, -0.3, low_m - 0.35}, {0.04, 0.3, low_m - 0.35}, 0.3);
    add(surfaces, below, {sign(0.6, 0.3, random), kSunShade});
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

}  // namespace glint::synth
