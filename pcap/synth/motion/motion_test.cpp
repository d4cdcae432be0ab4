// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/motion.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pcap/synth/motion/route.hpp"
#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// A corridor to walk up and down in, indoors.
Route corridor() { return {.points_m = {{0, 0, 0}, {30, 0, 0}}, .clear_height_m = 2.6}; }

// Streets to the left round a block, outdoors.
Route block() {
  return {.points_m = {{0, 0, 0}, {150, 0, 0}, {150, 90, 0}, {0, 90, 0}},
          .closed = true,
          .corner_radius_m = 12.0};
}

Route stairs() {
  return {.points_m = {{0, 0, 0},
                       {5, 0, 0},
                       {9, 0, 2.4},
                       {10.5, 0, 2.4},
                       {10.5, 1.5, 2.4},
                       {6, 1.5, 4.8},
                       {0, 1.5, 4.8}},
          .corner_radius_m = 0.7,
          .clear_height_m = 2.6};
}

Motion make(const Route& route, std::string_view kind, std::uint64_t seed = 1) {
  return make_motion(route, {.kind = std::string(kind)}, seed);
}

Eigen::Vector3d velocity_mps(const Motion& motion, double t_s, double step_s = 1e-3) {
  return (motion(t_s + step_s).translation_m - motion(t_s - step_s).translation_m) / (2 * step_s);
}

Eigen::Vector3d acceleration_mps2(const Motion& motion, double t_s, double step_s) {
  return (motion(t_s + step_s).translation_m + motion(t_s - step_s).translation_m -
          2.0 * motion(t_s).translation_m) /
         (step_s * step_s);
}

// About the sensor's own axes.
Eigen::Vector3d rate_radps(const Motion& motion, double t_s, double step_s = 1e-3) {
  return so3_log(motion(t_s - step_s).rotation.conjugate() * motion(t_s + step_s).rotation) /
         (2 * step_s);
}

bool same(const Pose& a, const Pose& b) {
  return a.translation_m == b.translation_m && a.rotation.coeffs() == b.rotation.coeffs();
}

class EveryMotion : public testing::TestWithParam<std::string_view> {};

TEST_P(EveryMotion, RestsExactlyAndThenGoes) {
  for (const Route& route : {corridor(), block(), stairs()}) {
    for (const double rest_s : {0.0, 1.0, 2.7}) {
      const Motion motion =
          make_motion(route, {.kind = std::string(GetParam()), .rest_s = rest_s}, 5);
      const Pose start = motion(0.0);
      for (double t_s = -3.0; t_s <= rest_s; t_s += 0.0137) {
        EXPECT_TRUE(same(motion(t_s), start)) << t_s;
      }
      EXPECT_GT((motion(rest_s + 5.0).translation_m - start.translation_m).norm(), 1.5);
      EXPECT_LT(start.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-9)
          << "stands upright and looks along the way";
    }
  }
}

TEST_P(EveryMotion, IsSmoothInAcceleration) {
  constexpr double kStep_s = 2e-3;
  const Motion motion = make(stairs(), GetParam(), 4);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_angular = Eigen::Vector3d::Zero();
  for (double t_s = 0.0; t_s < 60.0; t_s += kStep_s) {
    const Eigen::Vector3d now = acceleration_mps2(motion, t_s, kStep_s);
    const Eigen::Vector3d angular =
        (rate_radps(motion, t_s + kStep_s) - rate_radps(motion, t_s - kStep_s)) / (2 * kStep_s);
    ASSERT_LT((now - last).norm(), 0.12) << t_s;
    ASSERT_LT((angular - last_angular).norm(), 0.6) << t_s;
    last = now;
    last_angular = angular;
  }
}

TEST_P(EveryMotion, KeepsToTheWayWithoutEnd) {
  // Thirty years of it: nothing drifts, and what comes round is where the first round was.
  for (const double start_s : {0.0, 1e4, 1e9}) {
    const Motion motion = make(block(), GetParam(), 3);
    for (double t_s = start_s; t_s < start_s + 120.0; t_s += 0.5) {
      const Eigen::Vector3d p = motion(t_s).translation_m;
      const double from_edge_m = std::max(std::abs(p.x() - 75) - 75, std::abs(p.y() - 45) - 45);
      EXPECT_LT(from_edge_m, 0.3) << t_s;
      EXPECT_GT(from_edge_m, -5.5) << t_s;
    }
  }
}

TEST_P(EveryMotion, TurnsAtTheEndsOfAnOpenRoute) {
  const Motion motion = make(corridor(), GetParam(), 3);
  double least_m = 100.0;
  double most_m = -100.0;
  int there = 0;
  int back = 0;
  for (double t_s = 0.0; t_s < 150.0; t_s += 0.05) {
    const double x = motion(t_s).translation_m.x();
    least_m = std::min(least_m, x);
    most_m = std::max(most_m, x);
    const double speed = velocity_mps(motion, t_s).x();
    there += speed > 0.5 ? 1 : 0;
    back += speed < -0.5 ? 1 : 0;
    EXPECT_LT(std::abs(motion(t_s).translation_m.y()), 0.25);
  }
  EXPECT_NEAR(least_m, 0.0, 0.1);
  EXPECT_NEAR(most_m, 30.0, 0.1);
  EXPECT_GT(there, 500);
  EXPECT_GT(back, 500);
}

TEST_P(EveryMotion, FollowsFromTheSeedAlone) {
  const Motion motion = make(block(), GetParam(), 3);
  EXPECT_TRUE(same(motion(12.3), make(block(), GetParam(), 3)(12.3)));
  EXPECT_FALSE(same(motion(12.3), make(block(), GetParam(), 4)(12.3)));
}

TEST_P(EveryMotion, LooksWhereItGoes) {
  // Handheld looks about; in the mean it looks ahead as well.
  const bool looks_about = GetParam() == std::string_view("handheld");
  const Motion motion = make(block(), GetParam(), 3);
  for (const double start_s : {5.0, 1e6}) {
    double mean = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const double t_s = start_s + 0.2 * i;
      const Eigen::Vector3d ahead = motion(t_s).rotation * Eigen::Vector3d::UnitX();
      const double cosine = ahead.dot(velocity_mps(motion, t_s).normalized());
      EXPECT_GT(cosine, looks_about ? 0.1 : 0.96) << t_s;
      mean += cosine / 1000;
    }
    EXPECT_GT(mean, looks_about ? 0.6 : 0.98);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryMotion,
                         testing::ValuesIn(motion_names().begin(), motion_names().end()),
                         [](const auto& i) { return std::string(i.param); });

struct Extremes {
  double speed_mps = 0.0, acceleration_mps2 = 0.0, yaw_radps = 0.0, tilt_rad = 0.0;
  double lowest_m = 1e9, highest_m = -1e9;
};

Extremes extremes(const Motion& motion, double seconds) {
  Extremes most;
  for (double t_s = 0.1; t_s < seconds; t_s += 0.02) {
    const Pose pose = motion(t_s);
    most.speed_mps = std::max(most.speed_mps, velocity_mps(motion, t_s).norm());
    // Averaged over 0.1 s, so that vibration does not count.
    most.acceleration_mps2 =
        std::max(most.acceleration_mps2, acceleration_mps2(motion, t_s, 0.1).norm());
    most.yaw_radps =
        std::max(most.yaw_radps, std::abs((pose.rotation * rate_radps(motion, t_s)).z()));
    most.tilt_rad =
        std::max(most.tilt_rad, std::acos((pose.rotation * Eigen::Vector3d::UnitZ()).z()));
    most.lowest_m = std::min(most.lowest_m, pose.translation_m.z());
    most.highest_m = std::max(most.highest_m, pose.translation_m.z());
  }
  return most;
}

TEST(Wheeled, RollsLowAndLevel) {
  const Extremes most = extremes(make(block(), "wheeled"), 120.0);
  EXPECT_NEAR(most.speed_mps, 1.5, 0.05);
  EXPECT_LT(most.acceleration_mps2, 1.3);
  EXPECT_NEAR(most.lowest_m, 0.6, 0.01);
  EXPECT_NEAR(most.highest_m, 0.6, 0.01);
  EXPECT_LT(most.tilt_rad, 0.02);
  EXPECT_LT(extremes(make(corridor(), "wheeled"), 120.0).yaw_radps, 1.1);
}

TEST(Wheeled, PitchFollowsTheSlopeAndWalkersStayUpright) {
  const Route ramp{.points_m = {{0, 0, 0}, {40, 0, 4}}};
  const Eigen::Vector3d rolling = make(ramp, "wheeled")(20.0).rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(rolling.z(), 0.1, 0.01) << "nose up";
  const Eigen::Vector3d walking = make(ramp, "walking")(20.0).rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(walking.z(), 0.0, 0.025);
}

TEST(Walking, BobsWithEveryStep) {
  const Motion motion = make(block(), "walking");
  std::vector<double> height_m;
  for (double t_s = 20.0; t_s < 30.0; t_s += 0.01) {
    height_m.push_back(motion(t_s).translation_m.z());
  }
  const auto [low, high] = std::minmax_element(height_m.begin(), height_m.end());
  EXPECT_NEAR(*high - *low, 0.044, 0.01);
  int rises = 0;
  for (std::size_t i = 1; i < height_m.size(); ++i) {
    rises += height_m[i - 1] < 1.25 && height_m[i] >= 1.25 ? 1 : 0;
  }
  EXPECT_GE(rises, 16);
  EXPECT_LE(rises, 22);
}

TEST(Walking, ClimbsStairsMoreSlowly) {
  const Motion motion = make(stairs(), "walking");
  double level_mps = 0.0;
  double climbing_mps = 0.0;
  for (double t_s = 0.0; t_s < 15.0; t_s += 0.1) {
    const Eigen::Vector3d velocity =
        2.5 * (motion(t_s + 0.2).translation_m - motion(t_s - 0.2).translation_m);
    const double x = motion(t_s).translation_m.x();
    if (x < 4.0) level_mps = std::max(level_mps, velocity.norm());
    if (x > 6.0 && x < 8.0) climbing_mps = std::max(climbing_mps, velocity.norm());
  }
  EXPECT_GT(level_mps, 1.1);
  EXPECT_GT(climbing_mps, 0.4);
  EXPECT_LT(climbing_mps, 0.9);
}

TEST(Handheld, LooksAboutWithTurnsOfUpToAHundredAndTwentyDegreesASecond) {
  double fastest_radps = 0.0;
  double tilt_rad = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Extremes most = extremes(make(block(), "handheld", seed), 120.0);
    fastest_radps = std::max(fastest_radps, most.yaw_radps);
    tilt_rad = std::max(tilt_rad, most.tilt_rad);
    EXPECT_GT(most.yaw_radps, 75.0 / 180.0 * M_PI) << seed;
    EXPECT_LT(most.acceleration_mps2, 4.0);
  }
  EXPECT_GT(fastest_radps, 100.0 / 180.0 * M_PI);
  EXPECT_LT(fastest_radps, 135.0 / 180.0 * M_PI);
  EXPECT_GT(tilt_rad, 6.0 / 180.0 * M_PI);
  EXPECT_LT(tilt_rad, 14.0 / 180.0 * M_PI);
}

TEST(Drone, KeepsWellBelowTheCeilingAndLeansIntoCurves) {
  const Extremes inside = extremes(make(corridor(), "drone"), 120.0);
  EXPECT_LT(inside.highest_m, 0.6 * 2.6);
  EXPECT_GT(inside.lowest_m, 0.6);
  EXPECT_GT(inside.highest_m - inside.lowest_m, 0.1) << "the height varies";
  EXPECT_LT(inside.speed_mps, 1.6);

  const Motion motion = make(block(), "drone");
  const Extremes outside = extremes(motion, 180.0);
  EXPECT_LT(outside.highest_m, 3.0);
  EXPECT_NEAR(outside.speed_mps, 3.0, 0.15);
  for (double t_s = 0.0; t_s < 180.0; t_s += 0.1) {
    if (rate_radps(motion, t_s).z() < 0.2) continue;
    EXPECT_LT((motion(t_s).rotation * Eigen::Vector3d::UnitY()).z(), -0.01) << "left side down";
  }
}

TEST(Vehicle, IsFastOnStraightsAndSlowInCurves) {
  const Motion motion = make(block(), "vehicle");
  const Extremes most = extremes(motion, 120.0);
  EXPECT_NEAR(most.speed_mps, 15.0, 0.2);
  EXPECT_LT(most.acceleration_mps2, 3.2) << "forwards and sideways together";
  EXPECT_LT(most.yaw_radps, 0.65);
  EXPECT_LT(most.tilt_rad, 0.06);
  EXPECT_NEAR(most.highest_m, 1.9, 0.05);
  double lateral_mps2 = 0.0;
  for (double t_s = 0.0; t_s < 120.0; t_s += 0.05) {
    lateral_mps2 = std::max(lateral_mps2, velocity_mps(motion, t_s).norm() *
                                              std::abs(rate_radps(motion, t_s, 0.1).z()));
  }
  EXPECT_GT(lateral_mps2, 2.0);
  EXPECT_LT(lateral_mps2, 2.8);
}

TEST(Vehicle, DoesNotBrakeForTheSmallKinksOfAPolyline) {
  Route circle{.points_m = {}, .closed = true, .corner_radius_m = 1.0};
  for (int i = 0; i < 250; ++i) {
    const double angle = 2.0 * M_PI * i / 250;
    circle.points_m.emplace_back(200.0 * std::cos(angle), 200.0 * std::sin(angle), 0.0);
  }
  const Motion motion = make(circle, "vehicle");
  for (double t_s = 20.0; t_s < 100.0; t_s += 1.0) {
    EXPECT_GT(velocity_mps(motion, t_s).norm(), 14.0) << t_s;
    EXPECT_NEAR(rate_radps(motion, t_s, 0.5).z(), 15.0 / 200.0, 0.02) << t_s;
  }
}

TEST(Motion, SpeedIsAsAskedFor) {
  const Motion motion = make_motion(block(), {.kind = "wheeled", .speed_mps = 0.4}, 1);
  EXPECT_NEAR(velocity_mps(motion, 30.0).norm(), 0.4, 0.02);
}

TEST(Motion, WrongOptionsAreRefusedWithWhatIsPossible) {
  const auto make_with = [](const MotionOptions& options) {
    return [options] { make_motion(block(), options, 1); };
  };
  EXPECT_THAT(make_with({.kind = "flying"}), ThrowsMessage<OptionError>(HasSubstr(
                                                 "unknown motion 'flying': choose one of wheeled, "
                                                 "walking, handheld, drone, vehicle")));
  for (const double speed : {-1.0, 1e-6, 1e3, std::nan("")}) {
    EXPECT_THAT(make_with({.speed_mps = speed}), ThrowsMessage<OptionError>(HasSubstr("speed")));
  }
  for (const double rest : {-1.0, 1e9, std::nan("")}) {
    EXPECT_THAT(make_with({.rest_s = rest}), ThrowsMessage<OptionError>(HasSubstr("rest")));
  }
}

}  // namespace
}  // namespace glint::synth
