// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <numbers>

#include "pcap/synth/paint/decoration.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kLengthM = 12.0;
constexpr double kWidthM = 9.0;
constexpr double kCenterX = 0.5 * kLengthM;
constexpr double kCenterY = 0.5 * kWidthM;
// The way round the middle: half its size, how far it may stray, and what stays clear of it.
constexpr double kWayX = 3.9;
constexpr double kWayY = 2.4;
constexpr double kStrayM = 0.25;
constexpr int kWayPoints = 14;
constexpr double kIslandX = 2.0;
constexpr double kIslandY = 0.7;

class Furniture {
 public:
  explicit Furniture(WorldBuilder& builder) : builder_(builder) {}

  // Shelves and cabinets along the walls, with gaps.
  void add_along_walls() {
    constexpr double kTurned = 0.5 * std::numbers::pi;
    line_up(kLengthM, [&](double at_m, const Eigen::Vector3d& size_m) {
      add(at_m, 0.5 * size_m.y(), size_m, 0.0);
    });
    line_up(kLengthM, [&](double at_m, const Eigen::Vector3d& size_m) {
      add(at_m, kWidthM - 0.5 * size_m.y(), size_m, 0.0);
    });
    line_up(kWidthM, [&](double at_m, const Eigen::Vector3d& size_m) {
      add(0.5 * size_m.y(), at_m, size_m, kTurned);
    });
  }

  // Tables, crates, bins and a pillar in the middle.
  void add_island(double room_height_m) {
    Random& random = builder_.random();
    for (int i = 0; i < 4; ++i) {
      const double x = kCenterX + kIslandX * (2.0 * i / 3.0 - 1.0);
      const double y = kCenterY + random.uniform(-kIslandY, kIslandY);
      if (i == 1) {
        add_round(x, y, random.uniform(0.15, 0.25), room_height_m);
      } else if (random.chance(0.3)) {
        add_round(x, y, random.uniform(0.2, 0.35), random.uniform(0.7, 1.4));
      } else {
        add(x, y, {random.uniform(0.5, 1.0), random.uniform(0.4, 0.8), random.uniform(0.7, 1.7)},
            random.uniform(0.0, std::numbers::pi));
      }
    }
  }

 private:
  template <class Place>
  void line_up(double wall_m, Place&& place) {
    Random& random = builder_.random();
    for (double at_m = random.uniform(0.5, 1.5); at_m < wall_m - 1.5;) {
      const Eigen::Vector3d size_m(random.uniform(0.5, 1.3), random.uniform(0.3, 0.6),
                                   random.uniform(0.6, 2.1));
      place(at_m + 0.5 * size_m.x(), size_m);
      at_m += size_m.x() + random.uniform(0.8, 2.5);
    }
  }
  void add(double x, double y, const Eigen::Vector3d& size_m, double yaw_rad) {
    add_box(builder_.surfaces(), {x, y, 0.0}, size_m, yaw_rad, side_);
  }
  void add_round(double x, double y, double radius_m, double height_m) {
    add_pillar(builder_.surfaces(), {x, y, 0.0}, radius_m, height_m, side_);
  }

  WorldBuilder& builder_;
  FaceLook side_ = [this](double width_m, double height_m) {
    return Look{furniture_side(width_m, height_m, builder_.random()), kLampShade};
  };
};

}  // namespace

World make_room(WorldBuilder& builder) {
  Random& random = builder.random();
  const double height_m = random.uniform(2.7, 3.3);
  add_shell(builder.surfaces(), {kLengthM, kWidthM, height_m}, builder.decorated_shell());
  Furniture furniture(builder);
  furniture.add_along_walls();
  furniture.add_island(height_m);

  Route route = ring_route({kCenterX, kCenterY}, kWayX, kWayY, kWayPoints, kStrayM, random);
  route.corner_radius_m = 2.5;
  route.clear_height_m = height_m;
  return builder.finish(std::move(route), "walking");
}

}  // namespace glint::synth
