// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/frontend.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "driver/core/scan_assembler.hpp"
#include "pcap/synth/simulator.hpp"
#include "slam/test_simulated_walk.hpp"

namespace glint::slam {
namespace {

constexpr int kColumns = 512;

// The scans of a short walk, cast once for all tests.
class FrontendTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    synth::SimulationOptions options;
    options.world = "room";
    options.seconds = 4.5;
    options.seed = 5;
    options.sensor.columns = kColumns;  // half a scan's work, as sanitizers make it slow
    simulator_ = new synth::Simulator(options);
    scans_ = new std::vector<LidarScan>;
    LidarScan scan;
    while (test::next_whole(*simulator_, scan)) scans_->push_back(scan);
  }
  static void TearDownTestSuite() {
    delete scans_;
    delete simulator_;
  }

  // Distance between the estimated and the true way from scan `from` to the present one, m.
  static double way_error_m(const Pose& start, const LidarScan& from, const OdometryEstimate& now) {
    const Pose estimated = start.inverse() * now.T_odom_sensor;
    const Pose truth =
        simulator_->true_pose(from.end_time).inverse() * simulator_->true_pose(now.stamp);
    return (estimated.translation_m - truth.translation_m).norm();
  }

  static LidarScan covered(LidarScan scan) {
    std::fill(scan.range_mm.data.begin(), scan.range_mm.data.end(), 0U);
    return scan;
  }

  static synth::Simulator* simulator_;
  static std::vector<LidarScan>* scans_;
  Frontend frontend_{simulator_->info(), {}};
};

synth::Simulator* FrontendTest::simulator_ = nullptr;
std::vector<LidarScan>* FrontendTest::scans_ = nullptr;

class FrontendPresets : public FrontendTest, public testing::WithParamInterface<const char*> {};

TEST_P(FrontendPresets, FollowsTheTruth) {
  Frontend frontend(simulator_->info(), preset_config(GetParam()));
  EXPECT_EQ(frontend.process(scans_->front()).state, TrackingState::kInit);
  for (std::size_t i = 1; i < scans_->size(); ++i) {
    const OdometryEstimate& estimate = frontend.process((*scans_)[i]);
    EXPECT_EQ(estimate.state, TrackingState::kTracking) << i;
    EXPECT_EQ(estimate.stamp, (*scans_)[i].end_time);
    EXPECT_LT(way_error_m({}, scans_->front(), estimate), 0.15) << i;
  }
}

TEST_F(FrontendTest, AnImuMakesPosesBetterWheneverItsMeasurementsCome) {
  const auto samples = test::measure_motion(*simulator_, scans_->front().column_time.front(),
                                            scans_->back().end_time);
  Frontend without(simulator_->info(), {});
  Frontend all_at_once(simulator_->info(), {});
  Frontend as_they_come(simulator_->info(), {});
  for (const ImuSample& sample : samples) all_at_once.add_imu(sample);
  double squares_without_m2 = 0.0;
  double squares_with_m2 = 0.0;
  std::size_t next = 0;
  for (const LidarScan& scan : *scans_) {
    for (; next < samples.size() && samples[next].gyro_time <= scan.end_time; ++next) {
      as_they_come.add_imu(samples[next]);
    }
    const double without_m = way_error_m({}, scans_->front(), without.process(scan));
    const OdometryEstimate& with = as_they_come.process(scan);
    const double with_m = way_error_m({}, scans_->front(), with);
    squares_without_m2 += without_m * without_m;
    squares_with_m2 += with_m * with_m;
    EXPECT_EQ(all_at_once.process(scan).T_odom_sensor.translation_m,
              with.T_odom_sensor.translation_m);
  }
  EXPECT_LT(squares_with_m2, 0.5 * squares_without_m2);
}

class FrontendUnderLoad : public FrontendTest, public testing::WithParamInterface<const char*> {};

TEST_P(FrontendUnderLoad, TrackingGoesOnWithLess) {
  SlamConfig config;
  config.load_level = GetParam();
  Frontend frontend(simulator_->info(), config);
  const LoadLevel level = load_level_of(GetParam());
  const bool sparing = level == LoadLevel::kKeypointsEverySecond;
  const int share = level >= LoadLevel::kFewerKeypoints ? 2 : 1;
  int without_keypoints = 0;
  for (std::size_t i = 0; i < scans_->size(); ++i) {
    const OdometryEstimate& estimate = frontend.process((*scans_)[i]);
    EXPECT_EQ(estimate.state, i == 0 ? TrackingState::kInit : TrackingState::kTracking) << i;
    EXPECT_LE(estimate.keypoints, config.orb_features / share + 50) << i;
    if (estimate.keypoints == 0) ++without_keypoints;
    EXPECT_LT(way_error_m({}, scans_->front(), estimate), 0.15) << i;
  }
  const int scans = static_cast<int>(scans_->size());
  EXPECT_EQ(without_keypoints, sparing ? scans / 2 : 0);
}

INSTANTIATE_TEST_SUITE_P(Levels, FrontendUnderLoad,
                         testing::Values("patches", "keypoints", "surface_points",
                                         "keypoints_every_second"));

INSTANTIATE_TEST_SUITE_P(Presets, FrontendPresets, testing::Values("paper", "full"));

// What each element of map optimisation adds is measured on long ways, see DESIGN.md.
TEST_F(FrontendTest, MapOptimisationCutsTheDriftOfTheOdometry) {
  SlamConfig without;
  without.planes = without.ba = false;
  Frontend odometry(simulator_->info(), without);
  double with_sum_m = 0.0;
  double without_sum_m = 0.0;
  for (std::size_t i = 0; i < scans_->size(); ++i) {
    const OdometryEstimate with = frontend_.process((*scans_)[i]);
    const OdometryEstimate alone = odometry.process((*scans_)[i]);
    with_sum_m += way_error_m({}, scans_->front(), with);
    without_sum_m += way_error_m({}, scans_->front(), alone);
  }
  EXPECT_LT(with_sum_m, 0.8 * without_sum_m);
}

TEST_F(FrontendTest, SurfacesAloneFollowARoom) {
  SlamConfig baseline;
  baseline.intensity = baseline.ba = false;
  Frontend frontend(simulator_->info(), baseline);
  for (const LidarScan& scan : *scans_) {
    const OdometryEstimate& estimate = frontend.process(scan);
    EXPECT_EQ(estimate.keypoints, 0);
    EXPECT_LT(way_error_m({}, scans_->front(), estimate), 0.3);
  }
}

TEST_F(FrontendTest, WhileItsPlaceIsLookedForThereAreProbesBetweenKeyframes) {
  frontend_.set_searching(true);
  std::vector<Keyframe> probes;
  std::uint64_t keyframes = 0;
  const LidarScan& at_rest = scans_->front();
  for (int i = 0; i < 12; ++i) {
    LidarScan scan = at_rest;
    for (SensorTime& time : scan.column_time) time = time + i * 100'000'000;
    scan.end_time = scan.end_time + i * 100'000'000;
    frontend_.process(scan);
    auto keyframe = frontend_.take_keyframe();
    if (!keyframe) continue;
    if (keyframe->probe) {
      EXPECT_EQ(keyframe->id, keyframes) << "the number of the one to come";
      EXPECT_GT(keyframe->features.size(), 100U);
      probes.push_back(std::move(*keyframe));
    } else {
      EXPECT_EQ(keyframe->id, keyframes++);
    }
  }
  EXPECT_EQ(keyframes, 1U) << "at rest there is one keyframe";
  ASSERT_EQ(probes.size(), 3U);
  EXPECT_EQ(probes[1].estimate.stamp - probes[0].estimate.stamp, 300'000'000);
}

TEST_F(FrontendTest, TheSameScansGiveTheSameBits) {
  Frontend again(simulator_->info(), {});
  for (const LidarScan& scan : *scans_) {
    const Pose a = frontend_.process(scan).T_odom_sensor;
    const Pose b = again.process(scan).T_odom_sensor;
    EXPECT_EQ(a.translation_m, b.translation_m);
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  }
}

TEST_F(FrontendTest, AShortBlackOutIsBridgedAndSaidToBeDegraded) {
  for (std::size_t i = 0; i < 40; ++i) {
    const bool dark = i >= 30 && i < 32;
    const LidarScan& scan = (*scans_)[i];
    const OdometryEstimate& estimate = frontend_.process(dark ? covered(scan) : scan);
    if (i > 0) {
      EXPECT_EQ(estimate.state, dark ? TrackingState::kDegraded : TrackingState::kTracking);
    }
    EXPECT_LT(way_error_m({}, scans_->front(), estimate), 0.2) << i;
    EXPECT_EQ(estimate.segment, 0U);
  }
}

TEST_F(FrontendTest, ALongBlackOutIsLostWithTheLastPoseHeldAndThenFoundAgain) {
  for (std::size_t i = 0; i < 20; ++i) frontend_.process((*scans_)[i]);
  for (int i = 0; i < 3; ++i) frontend_.process(covered((*scans_)[20]));
  const Pose held = frontend_.process(covered((*scans_)[20])).T_odom_sensor;
  const OdometryEstimate lost = frontend_.process(covered((*scans_)[20]));
  EXPECT_EQ(lost.state, TrackingState::kLost);
  EXPECT_EQ(lost.T_odom_sensor.translation_m, held.translation_m);
  const OdometryEstimate found = frontend_.process((*scans_)[22]);
  EXPECT_EQ(found.state, TrackingState::kTracking);
  EXPECT_LT(way_error_m({}, scans_->front(), found), 0.15);
}

TEST_F(FrontendTest, ASensorCarriedElsewhereRestartsInANewSegment) {
  synth::SimulationOptions options;
  options.world = "room";
  options.seconds = 1.0;
  options.seed = 99;
  options.sensor.columns = kColumns;
  synth::Simulator elsewhere(options);
  for (std::size_t i = 0; i < 20; ++i) frontend_.process((*scans_)[i]);
  LidarScan scan;
  OdometryEstimate estimate;
  while (test::next_whole(elsewhere, scan)) estimate = frontend_.process(scan);
  EXPECT_EQ(estimate.segment, 1U);
  EXPECT_EQ(estimate.state, TrackingState::kTracking);
}

TEST_F(FrontendTest, IncompleteScansAreDegradedOrNotUsed) {
  for (std::size_t i = 0; i < 5; ++i) frontend_.process((*scans_)[i]);
  LidarScan scan = (*scans_)[5];
  scan.columns_received = 435;  // 85 %
  EXPECT_EQ(frontend_.process(scan).state, TrackingState::kDegraded);
  EXPECT_GT(frontend_.process((*scans_)[6]).inliers, 0);
  scan = (*scans_)[7];
  scan.columns_received = 200;  // 39 %
  const OdometryEstimate& estimate = frontend_.process(scan);
  EXPECT_EQ(estimate.state, TrackingState::kDegraded);
  EXPECT_EQ(estimate.inliers, 0);
}

TEST_F(FrontendTest, StandingStillMakesOneKeyframeAndWalkingMore) {
  int keyframes = 0;
  for (std::size_t i = 0; i < 10; ++i) {  // the first second is at rest
    frontend_.process((*scans_)[i]);
    keyframes += frontend_.take_keyframe() ? 1 : 0;
  }
  EXPECT_EQ(keyframes, 1);
  for (std::size_t i = 10; i < scans_->size(); ++i) {
    frontend_.process((*scans_)[i]);
    const auto keyframe = frontend_.take_keyframe();
    if (!keyframe) continue;
    ++keyframes;
    EXPECT_GT(keyframe->points.size(), 5000U);
    EXPECT_EQ(keyframe->id, static_cast<std::uint64_t>(keyframes - 1));
  }
  EXPECT_GT(keyframes, 3);
  EXPECT_FALSE(frontend_.take_keyframe());
}

TEST_F(FrontendTest, KeyframePointsLieOnTheWorld) {
  double sum_m = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < scans_->size(); ++i) {
    frontend_.process((*scans_)[i]);
    const auto keyframe = frontend_.take_keyframe();
    if (!keyframe || i == 0) continue;
    const Pose pose = simulator_->true_pose(keyframe->estimate.stamp);
    for (std::size_t k = 0; k < keyframe->points.size(); k += 50) {
      const MapPoint& p = keyframe->points[k];
      sum_m += simulator_->scene().at(0.0).distance_to_surface_m(
          pose * Eigen::Vector3d(p.x_m, p.y_m, p.z_m));
      ++count;
    }
  }
  EXPECT_LT(sum_m / count, 0.02);
}

TEST_F(FrontendTest, ResetBeginsANewOrigin) {
  for (std::size_t i = 0; i < 30; ++i) frontend_.process((*scans_)[i]);
  frontend_.reset();
  const OdometryEstimate& estimate = frontend_.process((*scans_)[30]);
  EXPECT_EQ(estimate.state, TrackingState::kInit);
  EXPECT_EQ(estimate.segment, 1U);
  EXPECT_EQ(estimate.T_odom_sensor.translation_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(frontend_.process((*scans_)[31]).state, TrackingState::kTracking);
}

TEST_F(FrontendTest, AnotherSensorGoesOnFromTheLastPoseInANewSegment) {
  std::uint64_t keyframes = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    frontend_.process((*scans_)[i]);
    if (frontend_.take_keyframe()) ++keyframes;
  }
  const Pose last = frontend_.process((*scans_)[30]).T_odom_sensor;
  if (frontend_.take_keyframe()) ++keyframes;
  frontend_.change_sensor(simulator_->info());
  const OdometryEstimate& estimate = frontend_.process((*scans_)[31]);
  EXPECT_EQ(estimate.state, TrackingState::kInit);
  EXPECT_EQ(estimate.segment, 1U);
  EXPECT_EQ(estimate.T_odom_sensor.translation_m, last.translation_m);
  EXPECT_EQ(frontend_.take_keyframe().value().id, keyframes);
  EXPECT_EQ(frontend_.process((*scans_)[32]).state, TrackingState::kTracking);
}

// A jump of the sensor's clock by so many ns, from a column of the 15th scan on.
struct ClockStep {
  std::int64_t by_ns;
  int column;
};

class FrontendClockJump : public FrontendTest, public testing::WithParamInterface<ClockStep> {
 protected:
  static LidarScan stepped(LidarScan scan, std::size_t index) {
    const auto [by_ns, column] = GetParam();
    if (index < kJumpScan) return scan;
    for (int m = index == kJumpScan ? column : 0; m < kColumns; ++m) {
      scan.column_time[static_cast<std::size_t>(m)].ns += by_ns;
    }
    scan.end_time = scan.column_time.back();
    scan.mid_time = scan.column_time[kColumns / 2];
    return scan;
  }
  static constexpr std::size_t kJumpScan = 15;
};

TEST_P(FrontendClockJump, IsHarmless) {
  Frontend undisturbed(simulator_->info(), {});
  for (std::size_t i = 0; i < 30; ++i) {
    const LidarScan& scan = (*scans_)[i];
    const OdometryEstimate expected = undisturbed.process(scan);
    const OdometryEstimate& estimate = frontend_.process(stepped(scan, i));
    EXPECT_EQ(estimate.state, i == 0 ? TrackingState::kInit : TrackingState::kTracking) << i;
    const Pose difference = expected.T_odom_sensor.inverse() * estimate.T_odom_sensor;
    EXPECT_LT(difference.translation_m.norm(), i < kJumpScan ? 1e-12 : 0.03) << i;
    EXPECT_LT(so3_log(difference.rotation).norm(), 0.01) << i;
    EXPECT_LT((estimate.velocity - expected.velocity).norm(), 0.3) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, FrontendClockJump,
                         testing::Values(ClockStep{3'000'000'000, 0}, ClockStep{-3'000'000'000, 0},
                                         ClockStep{3'600'000'000'000, 0},
                                         ClockStep{-200'000'000, 0}, ClockStep{400'000'000, 0},
                                         ClockStep{3'000'000'000, kColumns / 2},
                                         ClockStep{-3'000'000'000, kColumns / 2}));

}  // namespace
}  // namespace glint::slam
