// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>
#include <numbers>

#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/paint/decoration.hpp"
#include "pcap/synth/worlds/climbing.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr int kRisers = 9;
constexpr double kLevelM = kRisers * kRiseM;
constexpr double kFlightM = (kRisers - 1) * kTreadM;
constexpr double kWayWidthM = 3.0;
constexpr double kPlatformM = 9.0;  // Across, the way in its middle.
constexpr double kRampM = 13.0;
constexpr double kHeightM = 9.0;

// The hall, seen from above: outward along the far side, up two flights; back along the near side,
// down two ramps.
struct Plan {
  double x;  ///< Size of the hall.
  double y;
  double near_y;  ///< Lanes of the way.
  double far_y;
  double first_x;   ///< Where the first flight begins.
  double second_x;  ///< Where the second does.
  double upper_x;   ///< Where the ramps begin; the upper level goes on to the end wall's side.
  double end_x;     ///< Where the upper level ends.
  double turn_x;    ///< Where the way turns back on it.
};

Plan choose_plan(Random& random) {
  Plan plan{};
  plan.x = random.uniform(87.0, 93.0);
  plan.y = random.uniform(28.0, 31.0);
  plan.near_y = random.uniform(4.5, 5.5);
  plan.far_y = plan.y - random.uniform(5.5, 6.5);
  plan.first_x = random.uniform(14.0, 22.0);
  plan.second_x = plan.first_x + kFlightM + random.uniform(11.0, 18.0);
  plan.end_x = plan.x - 3.0;
  plan.turn_x = plan.end_x - 4.5;
  plan.upper_x = plan.turn_x - 4.5;
  return plan;
}

class Hall {
 public:
  Hall(WorldBuilder& builder, const Plan& plan)
      : builder_(builder),
        plan_(plan),
        wall_{builder.material(Material::kPlaster), kLampLight},
        ground_{builder.material(Material::kPaving), kLampLight},
        concrete_{builder.material(Material::kConcrete), kLampShade},
        rail_{builder.material(Material::kMetal), kLampShade} {}

  void build() {
    add_room();
    add_levels();
    add_ramps();
    add_clutter();
  }

  [[nodiscard]] Flight flight(bool second) const {
    return {{second ? plan_.second_x : plan_.first_x, plan_.far_y, second ? kLevelM : 0.0},
            Eigen::Vector3d::UnitX(),
            kWayWidthM,
            kRisers};
  }
  // From the upper level's edge down.
  [[nodiscard]] std::vector<Eigen::Vector3d> way_down_m() const {
    const double x = plan_.upper_x;
    return {{x, plan_.near_y, 2.0 * kLevelM},
            {x - kRampM, plan_.near_y, kLevelM},
            {x - kRampM - kRestM, plan_.near_y, kLevelM},
            {x - 2.0 * kRampM - kRestM, plan_.near_y, 0.0}};
  }

 private:
  static constexpr double kRestM = 4.0;  // Of level floor between the ramps.

  void add_room() {
    const auto wall = [&](double, double) { return wall_; };
    const auto ceiling = [&](double, double) { return concrete_; };
    add_shell(builder_.surfaces(), {plan_.x, plan_.y, kHeightM},
              {wall, [&](double, double) { return ground_; }, ceiling});
    const std::vector<Eigen::Vector3d> corners_m = {
        {0, 0, 0}, {0, plan_.y, 0}, {plan_.x, plan_.y, 0}, {plan_.x, 0, 0}, {0, 0, 0}};
    for (std::size_t i = 0; i + 1 < corners_m.size(); ++i) {
      const Rectangle face = upright(corners_m[i], corners_m[i + 1], kHeightM);
      builder_.hang_pictures(face, 0.5, face.width_m, 4.0, kLampLight);
      add_windows(face);
    }
  }

  void add_windows(const Rectangle& face) {
    Random& random = builder_.random();
    const Look window{house_window(2.4, 1.8, random), kLampLight};
    const double step_m = random.uniform(4.0, 6.0);
    for (double u = random.uniform(1.0, 3.0); u + 2.4 < face.width_m; u += step_m) {
      builder_.add_flush(part(face, {u, 6.0, 2.4, 1.8}), window);
      // Big letters, as halls have them for their gates.
      if (random.chance(0.25)) builder_.hang_sign(face, {u, 4.4, 1.4, 1.0}, kLampLight);
    }
  }

  void add_platform(double from_x, double to_x, double from_y, double to_y, double z) {
    add_box(builder_.surfaces(), {0.5 * (from_x + to_x), 0.5 * (from_y + to_y), 0.0},
            {to_x - from_x, to_y - from_y, z}, 0.0, concrete_);
  }

  void railing(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    add_railing(builder_.surfaces(), from_m, to_m, rail_);
  }

  void add_levels() {
    const double near = plan_.far_y - 0.5 * kPlatformM;
    const double far = plan_.far_y + 0.5 * kPlatformM;
    const double lower_x = plan_.first_x + kFlightM;
    const double upper_x = plan_.second_x + kFlightM;
    add_platform(lower_x, plan_.second_x, near, far, kLevelM);
    add_platform(upper_x, plan_.end_x, near, far, 2.0 * kLevelM);
    const double wing_y = plan_.near_y - 0.5 * kWayWidthM - 0.5;
    add_platform(plan_.upper_x, plan_.end_x, wing_y, near, 2.0 * kLevelM);
    for (const bool second : {false, true}) {
      add_flight(builder_.surfaces(), flight(second), concrete_, concrete_);
      for (const double side : {-0.5 * kWayWidthM, 0.5 * kWayWidthM}) {
        const Eigen::Vector3d aside(0.0, side, 0.0);
        railing(flight(second).foot_m + aside, flight(second).end_m() + aside);
      }
    }
    for (const double y : {near, far}) {
      railing({lower_x, y, kLevelM}, {plan_.second_x, y, kLevelM});
    }
    const double top = 2.0 * kLevelM;
    railing({upper_x, near, top}, {plan_.upper_x, near, top});
    railing({upper_x, far, top}, {plan_.end_x, far, top});
    railing({plan_.end_x, wing_y, top}, {plan_.end_x, far, top});
    railing({plan_.upper_x, wing_y, top}, {plan_.end_x, wing_y, top});
    railing({plan_.upper_x, plan_.near_y + 0.5 * kWayWidthM, top}, {plan_.upper_x, near, top});
  }

  void add_ramps() {
    const auto down_m = way_down_m();
    add_ramp(builder_.surfaces(), down_m[1], down_m[0], kWayWidthM, ground_, concrete_);
    add_ramp(builder_.surfaces(), down_m[3], down_m[2], kWayWidthM, ground_, concrete_);
    const double half_m = 0.5 * kWayWidthM;
    add_platform(down_m[2].x(), down_m[1].x(), plan_.near_y - half_m, plan_.near_y + half_m,
                 kLevelM);
    for (std::size_t i = 0; i + 1 < down_m.size(); ++i) {
      for (const double side : {-half_m, half_m}) {
        const Eigen::Vector3d aside(0.0, side, 0.0);
        railing(down_m[i] + aside, down_m[i + 1] + aside);
      }
    }
  }

  // In the middle of the ground floor, where the way does not come.
  void add_clutter() {
    Random& random = builder_.random();
    const double low_y = plan_.near_y + 3.5;
    const double high_y = plan_.far_y - 0.5 * kPlatformM - 1.0;
    const FaceLook side = [&](double width_m, double height_m) {
      return Look{furniture_side(width_m, height_m, random), kLampShade};
    };
    for (double x = 9.0; x < plan_.upper_x - 2.0; x += random.uniform(3.0, 9.0)) {
      const Eigen::Vector3d at_m(x, random.uniform(low_y, high_y), 0.0);
      if (random.chance(0.4)) {
        add_pillar(builder_.surfaces(), at_m, random.uniform(0.25, 0.4), kHeightM,
                   [&](double, double) { return concrete_; });
      } else {
        add_box(builder_.surfaces(), at_m,
                {random.uniform(0.6, 2.2), random.uniform(0.5, 1.4), random.uniform(0.6, 2.3)},
                random.uniform(0.0, std::numbers::pi), side);
      }
    }
  }

  WorldBuilder& builder_;
  const Plan plan_;
  const Look wall_;
  const Look ground_;
  const Look concrete_;
  const Look rail_;
};

}  // namespace

World make_stairs(WorldBuilder& builder) {
  Random& random = builder.random();
  const Plan plan = choose_plan(random);
  Hall hall(builder, plan);
  hall.build();

  Route route;
  route.closed = true;
  route.corner_radius_m = 1.2;
  route.clear_height_m = kHeightM - 2.0 * kLevelM;
  const double start_x = random.uniform(3.5, 6.0);
  route.points_m = {{start_x, plan.near_y, 0.0}, {start_x, plan.far_y, 0.0}};
  for (const bool second : {false, true}) {
    route.points_m.push_back(hall.flight(second).begin_m());
    route.points_m.push_back(hall.flight(second).end_m());
  }
  const double top = 2.0 * kLevelM;
  route.points_m.emplace_back(plan.turn_x, plan.far_y, top);
  route.points_m.emplace_back(plan.turn_x, plan.near_y, top);
  for (const Eigen::Vector3d& point_m : hall.way_down_m()) route.points_m.push_back(point_m);
  if (random.chance(0.5)) std::reverse(route.points_m.begin(), route.points_m.end());
  return builder.finish(std::move(route), "walking");
}

}  // namespace glint::synth
