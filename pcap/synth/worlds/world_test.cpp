// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcap/synth/motion/motion.hpp"
#include "pcap/synth/option_error.hpp"
#include "pcap/synth/worlds/route_tools.hpp"

namespace glint::synth {
namespace {

World world(const std::string& name, std::uint64_t seed) {
  return make_world({.name = name, .seed = seed, .photographs = {}});
}

// Ranges all round at chest height from a place on the way.
std::vector<double> ranges_m(const World& w, const Eigen::Vector3d& ground_m, double t_s,
                             double height_m, int directions) {
  std::vector<double> ranges;
  const auto moment = w.scene.at(t_s);
  for (int i = 0; i < directions; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * (i + 0.3) / directions;
    const Ray ray{ground_m + height_m * Eigen::Vector3d::UnitZ(),
                  {std::cos(angle_rad), std::sin(angle_rad), 0.0}};
    const Sighting sighting = moment.cast(ray);
    ranges.push_back(sighting.surface != nullptr ? sighting.hit.distance_m : 1000.0);
  }
  return ranges;
}

bool indoors(const World& w) { return w.route.clear_height_m < 20.0; }

struct WorldCase {
  std::string name;
  std::uint64_t seed;
};

std::vector<WorldCase> all_cases() {
  std::vector<WorldCase> cases;
  for (const WorldEntry& entry : world_list()) {
    for (const std::uint64_t seed : {1U, 2U}) cases.push_back({std::string(entry.name), seed});
  }
  return cases;
}

void expect_clear_way(const World& w) {
  // Never nearer than the ground, which is 1.2 m below.
  const double clear_m = indoors(w) ? 0.4 : 1.15;
  const double aside_m = indoors(w) ? 0.4 : 1.5;
  double t_s = 0.0;
  for (const Eigen::Vector3d& place_m :
       places_along(w.route, std::max(0.5, length_m(w.route) / 120.0))) {
    t_s += 1.7;
    const auto moment = w.scene.at(t_s);
    EXPECT_GE(moment.distance_to_surface_m(place_m + 1.2 * Eigen::Vector3d::UnitZ()), clear_m)
        << place_m.transpose();
    for (const double height_m : {0.6, 1.3, 2.1}) {
      const auto around_m = ranges_m(w, place_m, t_s, height_m, 20);
      EXPECT_GE(*std::min_element(around_m.begin(), around_m.end()), aside_m)
          << place_m.transpose() << " at " << height_m;
    }
  }
}

void expect_ground(const World& w) {
  const auto moment = w.scene.at(0.0);
  for (const Eigen::Vector3d& place_m : places_along(w.route, length_m(w.route) / 100.0)) {
    const Ray down{place_m + Eigen::Vector3d(0.013, 0.017, 1.0), -Eigen::Vector3d::UnitZ()};
    const Sighting sighting = moment.cast(down);
    ASSERT_NE(sighting.surface, nullptr) << place_m.transpose();
    // Over stairs one goes straight from edge to edge.
    EXPECT_NEAR(sighting.hit.distance_m, 1.0, 0.2) << place_m.transpose();
  }
}

void expect_safe_journey(const World& w, std::uint64_t seed) {
  const auto names = motion_names();
  ASSERT_NE(std::find(names.begin(), names.end(), w.motion), names.end()) << w.motion;
  MotionOptions options;
  options.kind = w.motion;
  const Motion motion = make_motion(w.route, options, seed);
  for (double t_s = 0.0; t_s < 150.0; t_s += 1.5) {
    EXPECT_GT(w.scene.at(t_s).distance_to_surface_m(motion(t_s).translation_m), 0.25) << t_s;
  }
}

class EveryWorld : public testing::TestWithParam<WorldCase> {};

TEST_P(EveryWorld, LeadsOverGroundAndClearOfEverythingThatStandsOrMoves) {
  const World w = world(GetParam().name, GetParam().seed);
  expect_clear_way(w);
  expect_ground(w);
  expect_safe_journey(w, GetParam().seed);
}

INSTANTIATE_TEST_SUITE_P(Worlds, EveryWorld, testing::ValuesIn(all_cases()), [](const auto& i) {
  std::string name = i.param.name + "_" + std::to_string(i.param.seed);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// Ranges from some places of its way, the whole way round.
std::vector<double> views(const World& w) {
  std::vector<double> all;
  for (std::size_t i = 0; i < 5; ++i) {
    const auto ranges =
        ranges_m(w, w.route.points_m[i * w.route.points_m.size() / 5], 2.0, 1.0, 32);
    all.insert(all.end(), ranges.begin(), ranges.end());
  }
  return all;
}

TEST(Worlds, OfAnotherSeedAreLaidOutOtherwise) {
  for (const WorldEntry& entry : world_list()) {
    const auto here = views(world(std::string(entry.name), 3));
    const auto there = views(world(std::string(entry.name), 4));
    std::size_t different = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      different += std::abs(here[i] - there[i]) > 0.01 ? 1 : 0;
    }
    EXPECT_GT(different, here.size() / 3) << entry.name;
  }
}

TEST(Worlds, OfTheSameSeedAreTheSame) {
  for (const char* name : {"street", "floors"}) {
    EXPECT_EQ(views(world(name, 3)), views(world(name, 3))) << name;
  }
}

TEST(Worlds, AnUnknownOneIsAnsweredWithTheKnownOnes) {
  try {
    world("moon", 1);
    FAIL();
  } catch (const OptionError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("unknown world 'moon': choose one of"), std::string::npos) << message;
    for (const WorldEntry& entry : world_list()) {
      EXPECT_NE(message.find(entry.name), std::string::npos) << message;
    }
  }
}

TEST(Worlds, HangUpPhotographsWherePostersHang) {
  // White as nothing else in a corridor is.
  const Photograph white{8, 8, std::vector<std::uint8_t>(64, 255)};
  const auto white_share = [](const World& w) {
    const auto moment = w.scene.at(0.0);
    int white_rays = 0;
    int rays = 0;
    for (const Eigen::Vector3d& place_m : places_along(w.route, 0.5)) {
      const Ray ray{place_m + 1.3 * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY()};
      const Hit hit = moment.cast(ray).hit;
      const Surface* surface = moment.cast(ray).surface;
      white_rays += surface->albedo->sample(hit.u_m, hit.v_m, 0.01) > 0.98;
      ++rays;
    }
    return static_cast<double>(white_rays) / rays;
  };
  EXPECT_LT(white_share(world("corridor", 1)), 0.02);
  EXPECT_GT(white_share(make_world({.name = "corridor", .seed = 1, .photographs = {white}})), 0.08);
}

TEST(Building, LeadsBackToItsStartAfterTwoHundredMetres) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World w = world("building", seed);
    EXPECT_TRUE(w.route.closed);
    EXPECT_NEAR(length_m(w.route), 200.0, 15.0);
  }
}

TEST(Building, HasFourCorridorsThatLookAlike) {
  const World w = world("building", 1);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point_m : w.route.points_m) box.extend(point_m);
  const auto moment = w.scene.at(0.0);
  // Along the outer walls at a height where nothing hangs, from their corners on.
  const auto outer = [&](double along_m, int corridor) {
    const double angle_rad = 0.5 * std::numbers::pi * corridor;
    const Eigen::Vector3d ahead(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    const Eigen::Vector3d left(-ahead.y(), ahead.x(), 0.0);
    const Eigen::Vector3d half = 0.5 * box.diagonal();
    // From the end of each corridor back.
    const Eigen::Vector3d end_m = box.center() +
                                  half.cwiseProduct(ahead.cwiseAbs()).norm() * ahead -
                                  half.cwiseProduct(left.cwiseAbs()).norm() * left;
    const Ray ray{end_m - along_m * ahead + 0.3 * Eigen::Vector3d::UnitZ(), -left};
    const Sighting s = moment.cast(ray);
    return s.surface->albedo->sample(s.hit.u_m, s.hit.v_m, 0.02);
  };
  double apart = 0.0;
  double contrast = 0.0;
  constexpr int kPlaces = 150;
  for (int i = 0; i < kPlaces; ++i) {
    const double along_m = 2.0 + 0.2 * i;
    apart += std::abs(outer(along_m, 0) - outer(along_m, 1)) / kPlaces;
    contrast += std::abs(outer(along_m, 0) - outer(along_m + 1.3, 1)) / kPlaces;
  }
  EXPECT_LT(apart, 0.6 * contrast);
}

TEST(Floors, AreAlikeOneAboveTheOther) {
  const World w = world("floors", 1);
  const auto& points_m = w.route.points_m;
  const double storey_m = points_m.back().z() - points_m.front().z();
  EXPECT_NEAR(storey_m, 3.2, 0.25);
  EXPECT_FALSE(w.route.closed);
  // The way upstairs is that downstairs, backwards.
  EXPECT_NEAR((points_m.front() - points_m.back()).head<2>().norm(), 0.0, 1e-9);
  const auto below = ranges_m(w, points_m[1], 0.0, 1.0, 50);
  const auto above = ranges_m(w, points_m[points_m.size() - 2], 0.0, 1.0, 50);
  for (std::size_t i = 0; i < below.size(); ++i) EXPECT_NEAR(below[i], above[i], 0.02);
}

TEST(Stairs, LeadOverThreeLevelsAndBack) {
  const World w = world("stairs", 1);
  EXPECT_TRUE(w.route.closed);
  EXPECT_NEAR(length_m(w.route), 200.0, 20.0);
  for (const double level_m : {0.0, 1.53, 3.06}) {
    const auto on_level = [&](const Eigen::Vector3d& point_m) {
      return std::abs(point_m.z() - level_m) < 0.01;
    };
    EXPECT_GE(std::count_if(w.route.points_m.begin(), w.route.points_m.end(), on_level), 2);
  }
}

TEST(Hill, SlopesByFifteenDegreesAtMostAndNotMuchLess) {
  const World w = world("hill", 1);
  EXPECT_NEAR(length_m(w.route), 400.0, 20.0);
  const auto moment = w.scene.at(0.0);
  double steepest = 0.0;
  for (double x = -70.0; x < 70.0; x += 3.1) {
    for (double y = -70.0; y < 70.0; y += 3.1) {
      const Sighting s = moment.cast({{x, y, 2.0 + 1e3}, -Eigen::Vector3d::UnitZ()});
      ASSERT_NE(s.surface, nullptr);
      // Of trees and rocks there are few; they are steep.
      const double slope_rad = std::acos(std::min(1.0, std::abs(s.hit.normal.z())));
      if (slope_rad < 0.3) steepest = std::max(steepest, slope_rad);
    }
  }
  EXPECT_GT(steepest, 0.17);
  EXPECT_LT(steepest, 0.29);
}

// Of rays all round from places along the route.
int rays_on_moving_things(const World& w) {
  int moving = 0;
  for (const Eigen::Vector3d& place_m : places_along(w.route, 4.0)) {
    const auto moment = w.scene.at(1.0);
    for (int i = 0; i < 90; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / 90;
      const Ray ray{place_m + 1.0 * Eigen::Vector3d::UnitZ(),
                    {std::cos(angle_rad), std::sin(angle_rad), 0.0}};
      moving += moment.cast(ray).moving;
    }
  }
  return moving;
}

World street_with(double traffic) {
  WorldOptions options;
  options.name = "street";
  options.seed = 1;
  options.traffic = traffic;
  return make_world(options);
}

TEST(Street, HasTrafficThatMovesSmoothly) {
  EXPECT_GT(rays_on_moving_things(world("street", 1)), 50);
}

TEST(Street, HasAsMuchTrafficAsAskedFor) {
  EXPECT_EQ(rays_on_moving_things(street_with(0.0)), 0);
  const int usual = rays_on_moving_things(street_with(1.0));
  EXPECT_EQ(usual, rays_on_moving_things(world("street", 1)));
  EXPECT_GT(rays_on_moving_things(street_with(10.0)), 3 * usual);
  for (const double impossible : {-1.0, 10.1, std::nan("")}) {
    EXPECT_THROW(street_with(impossible), OptionError) << impossible;
  }
}

TEST(Campus, LeadsOverFiveKilometresPastPlacesSeenBefore) {
  const World w = world("campus", 1);
  EXPECT_GT(length_m(w.route), 5000.0);
  constexpr double kStepM = 5.0;
  const auto places = places_along(w.route, kStepM);
  int seen_before = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k + 40 < i; ++k) {
      if ((places[i] - places[k]).norm() > 3.0) continue;
      ++seen_before;
      break;
    }
  }
  EXPECT_GT(seen_before, 50);
}

}  // namespace
}  // namespace glint::synth
