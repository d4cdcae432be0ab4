// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <array>
#include <cmath>

#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/worlds/things.hpp"

namespace glint::synth {
namespace {

constexpr double kWindowWidthM = 1.2;
constexpr double kWindowHeightM = 1.4;

// How one house is built; all of its sides have it in common.
struct Style {
  int storeys;
  double storey_m;
  double bay_m;  ///< From window to window.
  Look wall;
  Look band;
  std::array<Look, 3> windows;
  bool shop;
  bool balconies;

  [[nodiscard]] double height_m() const { return storeys * storey_m + 0.4; }
};

Style choose_style(WorldBuilder& builder, int storeys) {
  Random& random = builder.random();
  constexpr std::array<Material, 3> kWalls = {Material::kBrick, Material::kPlaster,
                                              Material::kConcrete};
  const double kind = random.uniform();
  const Material material = kWalls[kind < 0.35 ? 0 : (kind < 0.85 ? 1 : 2)];
  const auto window = [&] {
    return Look{house_window(kWindowWidthM, kWindowHeightM, random), kSunShade};
  };
  Style style{.storeys = storeys,
              .storey_m = random.uniform(2.8, 3.2),
              .bay_m = random.uniform(2.1, 3.0),
              .wall = {builder.material(material, random.below(4)), kSunShade},
              .band = {builder.material(Material::kConcrete, random.below(2)), kSunShade},
              .windows = {window(), window(), window()},
              .shop = random.chance(0.25),
              .balconies = storeys > 1 && random.chance(0.3)};
  return style;
}

void add_balcony(Surfaces& surfaces, const Rectangle& wall, double u_m, double v_m,
                 const Style& style) {
  const Eigen::Vector3d outwards = wall.u_axis.cross(wall.v_axis);
  const Eigen::Vector3d left =
      wall.corner_m + (u_m - 0.4) * wall.u_axis + (v_m - 0.9) * wall.v_axis;
  const Eigen::Vector3d along = (kWindowWidthM + 0.8) * wall.u_axis;
  const Eigen::Vector3d deep = 1.0 * outwards;
  add(surfaces, upright(left + deep, left + deep + along, 1.0), style.band);
  add(surfaces, upright(left, left + deep, 1.0), style.band);
  add(surfaces, upright(left + deep + along, left + along, 1.0), style.band);
  add(surfaces, between(left, left + along, left + deep), style.band);
}

// What an entrance or a shop takes of the ground floor, metres from the wall's left end.
struct Span {
  double from_m = 0.0;
  double to_m = 0.0;
  [[nodiscard]] bool overlaps(double from, double to) const { return from < to_m && to > from_m; }
};

Span add_entrance(Surfaces& surfaces, const Rectangle& wall, const Style& style,
                  WorldBuilder& builder) {
  Random& random = builder.random();
  const double width_m = random.uniform(1.0, 1.3);
  const double at_m = random.uniform(0.15, 0.75) * (wall.width_m - width_m);
  add_flush(surfaces, part(wall, {at_m, 0.0, width_m, 2.2}),
            {house_door(width_m, 2.2, random), kSunShade});
  add_flush(surfaces, part(wall, {at_m + width_m + 0.2, 1.6, 0.4, 0.25}),
            {sign(0.4, 0.25, random), kSunShade});
  if (!style.shop) return {at_m - 0.2, at_m + width_m + 0.6};
  const double shop_m = std::min(4.5, wall.width_m - at_m - width_m - 1.0);
  if (shop_m < 2.0) return {at_m - 0.2, at_m + width_m + 0.6};
  const double from_m = at_m + width_m + 0.7;
  add_flush(surfaces, part(wall, {from_m, 0.5, shop_m, 1.8}),
            {house_window(shop_m, 1.8, random), kSunShade});
  add_flush(surfaces, part(wall, {from_m, 2.4, shop_m, 0.55}),
            {sign(shop_m, 0.55, random), kSunShade});
  return {at_m - 0.2, from_m + shop_m};
}

// Windows in rows, on the street's side a door.
void add_facade(Surfaces& surfaces, const Rectangle& wall, const Style& style, bool front,
                WorldBuilder& builder) {
  Random& random = builder.random();
  add(surfaces, wall, style.wall);
  add_flush(surfaces, part(wall, {0.0, 0.0, wall.width_m, 0.45}, 0.02), style.band);
  const Span taken = front ? add_entrance(surfaces, wall, style, builder) : Span{};
  const auto bays = static_cast<int>((wall.width_m - 0.8) / style.bay_m);
  const double first_m = 0.5 * (wall.width_m - bays * style.bay_m + style.bay_m - kWindowWidthM);
  for (int storey = 0; storey < style.storeys; ++storey) {
    const double v = storey * style.storey_m + 1.0;
    for (int bay = 0; bay < bays; ++bay) {
      const double u = first_m + bay * style.bay_m;
      if (storey == 0 && taken.overlaps(u, u + kWindowWidthM)) continue;
      if (random.chance(front ? 0.05 : 0.35)) continue;
      add_flush(surfaces, part(wall, {u, v, kWindowWidthM, kWindowHeightM}, 0.01),
                style.windows[static_cast<std::size_t>(random.below(3))]);
      const bool balcony = front && style.balconies && storey > 0 && bay % 2 == 0;
      if (balcony) add_balcony(surfaces, wall, u, v, style);
    }
  }
  if (front && random.chance(0.5)) {
    const Area bill{random.uniform(0.2, 0.8) * (wall.width_m - 1.0), 0.9, 0.7, 0.9};
    if (!taken.overlaps(bill.u_m, bill.u_m + bill.width_m)) {
      add_flush(surfaces, part(wall, bill, 0.02),
                {poster(bill.width_m, bill.height_m, builder.photographs(), random), kSunShade});
    }
  }
}

// A ridge along x, or flat.
void add_roof(Surfaces& surfaces, double x, double y, double eaves_m, const Style& style,
              WorldBuilder& builder) {
  Random& random = builder.random();
  const Look tiles{builder.material(Material::kRoof, random.below(2)), kSunlight};
  if (random.chance(0.35)) {
    add(surfaces, level({-x, -y, eaves_m}, 2.0 * x, 2.0 * y), tiles);
    return;
  }
  const double ridge_m = eaves_m + y * std::tan(random.uniform(0.5, 0.8));
  add(surfaces, between({-x, -y, eaves_m}, {x, -y, eaves_m}, {-x, 0.0, ridge_m}), tiles);
  add(surfaces, between({x, y, eaves_m}, {-x, y, eaves_m}, {x, 0.0, ridge_m}), tiles);
  add_triangle(surfaces, {x, -y, eaves_m}, {x, y, eaves_m}, {x, 0.0, ridge_m}, style.wall);
  add_triangle(surfaces, {-x, y, eaves_m}, {-x, -y, eaves_m}, {-x, 0.0, ridge_m}, style.wall);
}

}  // namespace

BodyPtr house(WorldBuilder& builder, double width_m, double depth_m, int storeys) {
  const Style style = choose_style(builder, storeys);
  const double x = 0.5 * width_m;
  const double y = 0.5 * depth_m;
  Surfaces surfaces;
  const auto facade = [&](double from_x, double from_y, double to_x, double to_y, bool front) {
    add_facade(surfaces, upright({from_x, from_y, 0.0}, {to_x, to_y, 0.0}, style.height_m()), style,
               front, builder);
  };
  facade(-x, -y, x, -y, true);
  facade(x, -y, x, y, false);
  facade(x, y, -x, y, false);
  facade(-x, y, -x, -y, false);
  add_roof(surfaces, x, y, style.height_m(), style, builder);
  // Drainpipes at the corners of the front.
  const Look pipe{builder.material(Material::kMetal), kSunShade};
  for (const double side : {-1.0, 1.0}) {
    add(surfaces, Cylinder{{side * (x - 0.15), -y - 0.06, 0.0}, 0.05, style.height_m()}, pipe);
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

}  // namespace glint::synth
