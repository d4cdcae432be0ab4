// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/relocalizer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slam/loops/test_gallery.hpp"

namespace glint::slam {
namespace {

/// Galleries, a map of some of them, and a sensor that wakes up anywhere.
struct Awakening {
  explicit Awakening(int galleries = 1, int pictured = 1)
      : gallery(galleries, pictured),
        relocalizer(std::make_shared<const Vocabulary>(gallery.vocabulary())) {}

  /// Walks a gallery ahead; its keyframes are the map's.
  void map_gallery(int at_gallery) {
    for (double x_m = 2.0; x_m < 28.0; x_m += 0.5) {
      const Pose truth = gallery_pose(x_m, 0.1, 0.0, at_gallery);
      Keyframe keyframe = gallery.look(truth, keyframes++, 0.0);
      keyframe.estimate.segment = static_cast<std::uint32_t>(at_gallery);
      relocalizer.remember(keyframe, truth);
    }
  }

  /// A scan; the sensor's odometry began elsewhere.
  std::optional<Relocation> see(const Pose& truth, std::uint32_t segment = 7) {
    Keyframe scan = gallery.look(truth, keyframes + scans++, 0.0);
    scan.estimate.T_odom_sensor = T_odom_world * truth;
    scan.estimate.segment = segment;
    return relocalizer.locate(scan);
  }

  /// Walks back from there until it is found: where by how much it is off then, in m or rad.
  std::optional<double> walk(double from_m, int at_gallery, int steps = 12) {
    for (int i = 0; i < steps; ++i) {
      const Pose truth = gallery_pose(from_m - 0.3 * i, -0.2, M_PI + 0.1 * i, at_gallery);
      const auto found = see(truth);
      if (!found) continue;
      const Pose error = truth.inverse() * found->T_map_sensor;
      return std::max(error.translation_m.norm(), so3_log(error.rotation).norm());
    }
    return std::nullopt;
  }

  TestGallery gallery;
  Relocalizer relocalizer;
  Pose T_odom_world{so3_exp({0.0, 0.0, 1.0}), {50.0, -20.0, 3.0}};
  std::uint64_t keyframes = 0;
  std::uint64_t scans = 0;
};

TEST(Relocalizer, FindsASensorThatWakesUpAnywhereTurnedAnyWay) {
  for (const double from_m : {8.0, 15.0, 24.0}) {
    Awakening robot;
    robot.map_gallery(0);
    const auto error = robot.walk(from_m, 0);
    ASSERT_TRUE(error.has_value()) << from_m;
    EXPECT_LT(*error, 0.08) << from_m;
    EXPECT_LE(robot.scans, 5U) << from_m;
  }
}

TEST(Relocalizer, ThreeScansMustAgreeAlsoAtRest) {
  Awakening robot;
  robot.map_gallery(0);
  const Pose truth = gallery_pose(14.0, 0.3, 2.0);
  EXPECT_FALSE(robot.see(truth));
  EXPECT_NEAR(robot.relocalizer.confidence(), 1.0 / 3.0, 1e-9);
  EXPECT_FALSE(robot.see(truth));
  const auto found = robot.see(truth);
  ASSERT_TRUE(found);
  EXPECT_EQ(robot.relocalizer.confidence(), 1.0);
  ASSERT_EQ(found->sightings.size(), 3U);
  for (const PlaceSighting& sighting : found->sightings) {
    EXPECT_LT(sighting.edge.from, robot.keyframes);
    EXPECT_GE(sighting.edge.to, robot.keyframes);
    EXPECT_GT(sighting.edge.covariance.diagonal().minCoeff(), 0.0);
  }
}

TEST(Relocalizer, ScansThatOdometryDoesNotLinkDoNotBearOneAnotherOut) {
  Awakening robot;
  robot.map_gallery(0);
  const Pose truth = gallery_pose(14.0, 0.3, 2.0);
  EXPECT_FALSE(robot.see(truth, 7));
  EXPECT_FALSE(robot.see(truth, 7));
  EXPECT_FALSE(robot.see(truth, 8)) << "tracking restarted in between";
}

TEST(Relocalizer, ScansThatContradictOdometryDoNotBearOneAnotherOut) {
  Awakening robot;
  robot.map_gallery(0);
  const Pose truth = gallery_pose(14.0, 0.3, 2.0);
  for (int i = 0; i < 8; ++i) {
    EXPECT_FALSE(robot.see(truth)) << i;
    robot.T_odom_world.translation_m.x() += 0.8;
  }
}

TEST(Relocalizer, AGalleryOfTheSameMakeIsNotTheMaps) {
  Awakening robot(2, 2);
  robot.map_gallery(0);
  for (const double from_m : {10.0, 18.0, 25.0}) {
    EXPECT_FALSE(robot.walk(from_m, 1)) << from_m;
    robot.relocalizer.begin_anew();
  }
}

TEST(Relocalizer, ABareGalleryOfTheSameMakeIsNotThePicturedOneOfTheMap) {
  Awakening robot(2, 1);
  robot.map_gallery(0);
  for (const double from_m : {10.0, 18.0, 25.0}) {
    EXPECT_FALSE(robot.walk(from_m, 1)) << from_m;
    robot.relocalizer.begin_anew();
  }
}

TEST(Relocalizer, OfTwoGalleriesOfTheSameMakeItIsTheOneWithThePicturesThatAreSeen) {
  Awakening robot(2, 2);
  robot.map_gallery(0);
  robot.map_gallery(1);
  const auto error = robot.walk(22.0, 1, 30);
  ASSERT_TRUE(error);
  EXPECT_LT(*error, 0.08);
}

TEST(Relocalizer, BetweenIdenticalGalleriesItSaysNothing) {
  Awakening robot(2, 0);
  robot.map_gallery(0);
  robot.map_gallery(1);
  EXPECT_FALSE(robot.walk(24.0, 0, 40));
  EXPECT_FALSE(robot.walk(20.0, 1, 40));
}

TEST(Relocalizer, AGuessTellsIdenticalGalleriesApart) {
  for (const int at : {0, 1}) {
    Awakening robot(2, 0);
    robot.map_gallery(0);
    robot.map_gallery(1);
    PlaceGuess guess;
    guess.T_map_sensor = gallery_pose(23.0, 0.3, M_PI + 0.2, at);
    robot.relocalizer.begin_near(guess);
    const auto error = robot.walk(24.0, at);
    ASSERT_TRUE(error) << at;
    EXPECT_LT(*error, 0.08);
    EXPECT_FALSE(robot.relocalizer.guess_dropped());
  }
}

TEST(Relocalizer, AGuessThatIsWrongIsDroppedAndTheSensorFoundWhereItIs) {
  Awakening robot;
  robot.map_gallery(0);
  PlaceGuess guess;
  guess.T_map_sensor = gallery_pose(5.0, 0.0, 0.0);
  guess.knows_heading = false;
  guess.sigma_m = 0.5;
  robot.relocalizer.begin_near(guess);
  const Pose truth = gallery_pose(20.0, -0.2, 2.0);
  int dropped = 0;
  for (int i = 0; i < 12; ++i) EXPECT_FALSE(robot.see(truth)) << i;
  EXPECT_FALSE(robot.relocalizer.guess_dropped());
  std::optional<Relocation> found;
  for (int i = 0; i < 4 && !found; ++i) {
    found = robot.see(truth);
    dropped += robot.relocalizer.guess_dropped() ? 1 : 0;
  }
  ASSERT_TRUE(found);
  EXPECT_EQ(dropped, 1) << "it is told once";
  EXPECT_LT((found->T_map_sensor.translation_m - truth.translation_m).norm(), 0.08);
}

TEST(Relocalizer, AGuessOfTheWrongHeadingIsNoPlace) {
  Awakening robot;
  robot.map_gallery(0);
  PlaceGuess guess;
  guess.T_map_sensor = gallery_pose(20.0, -0.2, 2.0 - M_PI);
  robot.relocalizer.begin_near(guess);
  for (int i = 0; i < 12; ++i) EXPECT_FALSE(robot.see(gallery_pose(20.0, -0.2, 2.0))) << i;
}

TEST(Relocalizer, AnEmptyMapHoldsNothing) {
  Awakening robot;
  EXPECT_FALSE(robot.walk(15.0, 0));
  EXPECT_EQ(robot.relocalizer.confidence(), 0.0);
}

}  // namespace
}  // namespace glint::slam
