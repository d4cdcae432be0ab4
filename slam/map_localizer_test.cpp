// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_localizer.hpp"

#include <gtest/gtest.h>

#include "slam/loops/test_gallery.hpp"

namespace glint::slam {
namespace {

/// A gallery whose map is known, and a robot whose odometry drifts on a walk through it.
class MapLocalizerTest : public testing::Test {
 protected:
  MapLocalizerTest() : localizer_(mapped()) {}

  Relocalizer mapped() {
    Relocalizer map(std::make_shared<const Vocabulary>(gallery_.vocabulary()));
    for (double x_m = 2.0; x_m < 28.0; x_m += 0.5) {
      const Pose truth = gallery_pose(x_m, 0.1, 0.0);
      map.remember(gallery_.look(truth, next_++, 0.0), truth);
    }
    return map;
  }

  /// The keyframe that the robot takes there; odometry has it where it began plus its drift.
  Keyframe see(const Pose& truth, bool blind = false) {
    Keyframe keyframe = gallery_.look(truth, next_, 0.5 * static_cast<double>(next_));
    ++next_;
    keyframe.estimate.sequence = 5 * next_;
    keyframe.estimate.segment = segment_;
    keyframe.estimate.T_odom_sensor = drift_ * T_odom_world_ * truth;
    keyframe.edge_covariance.diagonal().setConstant(1e-6);
    if (blind) {
      keyframe.features = {};
      for (MapPoint& point : keyframe.points) point = {3.0F * point.z_m, 2.0F * point.x_m, 9.0F};
    }
    return keyframe;
  }
  /// Walks from `from_m` to `to_m`, 0.4 m a keyframe; the worst error in the map from `settled` on.
  double walk(double from_m, double to_m, bool blind = false) {
    double worst_m = 0.0;
    const int steps = static_cast<int>(std::abs(to_m - from_m) / 0.4);
    for (int i = 0; i <= steps; ++i) {
      const Pose truth = gallery_pose(from_m + (to_m - from_m) * i / steps, -0.2, M_PI);
      drift_.translation_m.y() += drift_m_;
      const Keyframe keyframe = see(truth, blind);
      localizer_.process(keyframe, correction_);
      if (!correction_.placed) continue;
      const Pose T_map = correction_.T_map_odom * keyframe.estimate.T_odom_sensor;
      worst_m = std::max(worst_m, (T_map.translation_m - truth.translation_m).norm());
    }
    return worst_m;
  }
  [[nodiscard]] double sigma_m() const {
    return std::sqrt(correction_.certainty->covariance.topLeftCorner<3, 3>().trace());
  }

  TestGallery gallery_;
  std::uint64_t next_ = 0;
  std::uint32_t segment_ = 3;
  double drift_m_ = 0.0;  ///< Of each keyframe.
  Pose drift_;
  Pose T_odom_world_{so3_exp({0.0, 0.0, 0.7}), {5.0, -2.0, 1.0}};
  MapLocalizer localizer_;
  MapCorrection correction_{{}, 4, false, 0.0, {}, {}};
};

TEST_F(MapLocalizerTest, AfterThePlaceIsFoundThePoseFollowsTheMapWhileOdometryDrifts) {
  drift_m_ = 0.01;
  EXPECT_LT(walk(24.0, 6.0), 0.1);
  ASSERT_TRUE(correction_.placed);
  EXPECT_GT(drift_.translation_m.norm(), 0.4);
  EXPECT_EQ(correction_.confidence, 1.0);
  EXPECT_EQ(correction_.epoch, 5U) << "it was found once; what followed were no jumps";
  EXPECT_LT(sigma_m(), 0.1);
  EXPECT_EQ(localizer_.searching_s(), 0.0);
}

TEST_F(MapLocalizerTest, PastPosesStayWhereTheMapHadThemThen) {
  walk(24.0, 18.0);
  const Pose truth = gallery_pose(17.9, -0.2, M_PI);
  const Keyframe then = see(truth);
  localizer_.process(then, correction_);
  drift_m_ = 0.01;
  walk(17.8, 6.0);
  const Pose T_map = correction_.map_pose(segment_, static_cast<double>(then.estimate.sequence),
                                          then.estimate.T_odom_sensor);
  EXPECT_LT((T_map.translation_m - truth.translation_m).norm(), 0.06);
}

TEST_F(MapLocalizerTest, WhatDoesNotFitIsLeftToOdometryAndTheCovarianceSaysSo) {
  walk(24.0, 18.0);
  const double sure_m = sigma_m();
  EXPECT_LT(walk(17.6, 10.0, true), 0.1);
  ASSERT_TRUE(correction_.placed);
  EXPECT_LT(correction_.confidence, 0.85);
  EXPECT_GT(sigma_m(), 1.5 * sure_m);
  EXPECT_LT(walk(9.6, 6.0), 0.1);
  EXPECT_EQ(correction_.confidence, 1.0) << "it fits again";
}

TEST_F(MapLocalizerTest, AfterTooManyMisfitsThePlaceIsLostAndFoundAgain) {
  walk(24.0, 18.0);
  const auto epoch = correction_.epoch;
  for (int i = 0; i < 4 && correction_.placed; ++i) walk(18.0, 6.0, true);
  EXPECT_FALSE(correction_.placed);
  EXPECT_EQ(correction_.epoch, epoch + 1);
  walk(18.0, 6.0, true);
  EXPECT_GT(localizer_.searching_s(), 5.0);
  EXPECT_LT(walk(20.0, 16.0), 0.1);
  EXPECT_TRUE(correction_.placed);
  EXPECT_EQ(correction_.epoch, epoch + 2);
}

TEST_F(MapLocalizerTest, CarriedOffUnnoticedItIsFoundWhereItIsAndThatIsAJump) {
  walk(24.0, 20.0);
  const auto epoch = correction_.epoch;
  drift_ = T_odom_world_ * gallery_pose(12.0, 0.0, M_PI / 2) * T_odom_world_.inverse();
  // Some keyframes pass before it is believed.
  walk(20.0, 15.0);
  EXPECT_LT(walk(14.6, 6.0), 0.1);
  EXPECT_GT(correction_.epoch, epoch);
}

TEST_F(MapLocalizerTest, ANewSegmentOfOdometryHasNoPlaceUntilItIsFound) {
  walk(24.0, 20.0);
  const auto epoch = correction_.epoch;
  ++segment_;
  T_odom_world_ = {};
  localizer_.process(see(gallery_pose(12.0, -0.2, M_PI)), correction_);
  EXPECT_FALSE(correction_.placed);
  EXPECT_EQ(correction_.certainty, nullptr);
  EXPECT_LT(walk(11.6, 8.0), 0.1);
  EXPECT_TRUE(correction_.placed);
  EXPECT_EQ(correction_.epoch, epoch + 2);
}

TEST_F(MapLocalizerTest, ASearchThatIsAskedForBeginsAnew) {
  walk(24.0, 20.0);
  localizer_.search_anew({}, correction_);
  EXPECT_FALSE(correction_.placed);
  EXPECT_LT(walk(19.6, 17.0), 0.1);
  EXPECT_TRUE(correction_.placed);
}

}  // namespace
}  // namespace glint::slam
