// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/imu_track.hpp"

#include <gtest/gtest.h>

#include "driver/core/pose.hpp"

namespace glint::slam {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;

/// A sensor that turns evenly about a tilted axis and is accelerated evenly in the world.
struct EvenMotion {
  Eigen::Vector3d rate_radps{0.3, -0.4, 0.9};
  Eigen::Vector3d acceleration_mps2{0.5, -0.2, 0.1};
  Eigen::Vector3d gravity_mps2{0.0, 0.0, -9.80665};
  Eigen::Vector3d velocity_mps{1.0, 0.5, 0.0};

  [[nodiscard]] Pose at(double t_s) const {
    return {so3_exp(rate_radps * t_s), velocity_mps * t_s + 0.5 * t_s * t_s * acceleration_mps2};
  }
  [[nodiscard]] ImuSample sample(SensorTime t) const {
    ImuSample sample;
    sample.accel_time = sample.gyro_time = t;
    sample.angular_rate_radps = rate_radps;
    const Eigen::Quaterniond rotation = at(static_cast<double>(t.ns) * kSecondsPerNs).rotation;
    sample.acceleration_mps2 = rotation.conjugate() * (acceleration_mps2 - gravity_mps2);
    return sample;
  }
  void fill(ImuTrack& track, int from, int to, const Eigen::Vector3d& bias_radps) const {
    for (int i = from; i <= to; ++i) {
      ImuSample measured = sample({i * kStep_ns});
      measured.angular_rate_radps += bias_radps;
      track.add(measured);
    }
  }
};

TEST(ImuTrack, TurnVelocityAndWayBetweenAnyTwoTimes) {
  const EvenMotion motion;
  ImuTrack track;
  motion.fill(track, 0, 100, Eigen::Vector3d::Zero());
  for (const auto& [a_ms, b_ms] : {std::pair{200, 300}, {203, 318}, {900, 1000}, {700, 600}}) {
    const SensorTime a{a_ms * 1'000'000LL};
    const SensorTime b{b_ms * 1'000'000LL};
    const double a_s = 1e-3 * a_ms;
    const double span_s = 1e-3 * (b_ms - a_ms);
    const auto measured = track.between(a, b);
    ASSERT_TRUE(measured);
    const Pose at_a = motion.at(a_s);
    const Pose truth = at_a.inverse() * motion.at(a_s + span_s);
    EXPECT_LT(measured->turn.angularDistance(truth.rotation), 1e-6);
    const Eigen::Quaterniond to_a = at_a.rotation.conjugate();
    const Eigen::Vector3d velocity_mps =
        to_a * (motion.velocity_mps + a_s * motion.acceleration_mps2);
    const Eigen::Vector3d way_m = velocity_mps * span_s +
                                  0.5 * span_s * span_s * (to_a * motion.gravity_mps2) +
                                  measured->way_m;
    EXPECT_LT((way_m - truth.translation_m).norm(), 2e-5) << a_ms << " to " << b_ms;
  }
}

TEST(ImuTrack, NothingIsSaidOfTimesWithoutMeasurements) {
  const EvenMotion motion;
  ImuTrack track;
  EXPECT_FALSE(track.between({0}, {kStep_ns}));
  motion.fill(track, 10, 30, Eigen::Vector3d::Zero());
  EXPECT_FALSE(track.between({0}, {20 * kStep_ns})) << "before the first";
  EXPECT_TRUE(track.between({10 * kStep_ns}, {32 * kStep_ns})) << "a little past the last";
  EXPECT_FALSE(track.between({10 * kStep_ns}, {40 * kStep_ns})) << "long after the last";
  motion.fill(track, 60, 70, Eigen::Vector3d::Zero());
  EXPECT_FALSE(track.between({20 * kStep_ns}, {65 * kStep_ns})) << "over a gap";
  EXPECT_TRUE(track.between({61 * kStep_ns}, {65 * kStep_ns}));
  motion.fill(track, 5, 20, Eigen::Vector3d::Zero());
  EXPECT_FALSE(track.between({61 * kStep_ns}, {65 * kStep_ns})) << "the clock went back";
  EXPECT_TRUE(track.between({6 * kStep_ns}, {15 * kStep_ns}));
}

TEST(ImuTrack, HoursLaterMotionsAreAsExact) {
  EvenMotion motion;
  motion.rate_radps.setZero();
  motion.acceleration_mps2.setZero();
  ImuTrack track;
  constexpr int kSamples = 400'000;  // more than an hour
  motion.fill(track, 0, kSamples, Eigen::Vector3d::Zero());
  const auto measured = track.between({(kSamples - 10) * kStep_ns}, {kSamples * kStep_ns});
  ASSERT_TRUE(measured);
  EXPECT_NEAR(measured->way_m.z(), 0.5 * 9.80665 * 0.01, 1e-9);
}

TEST(ImuTrack, TheBiasIsLearnedFromTurnsThatAreKnown) {
  const EvenMotion motion;
  const Eigen::Vector3d bias_radps(0.01, -0.02, 0.015);
  ImuTrack track;
  for (int scan = 0; scan < 200; ++scan) {
    motion.fill(track, 10 * scan + (scan > 0 ? 1 : 0), 10 * scan + 10, bias_radps);
    const SensorTime a{10 * scan * kStep_ns};
    const SensorTime b = a + 10 * kStep_ns;
    track.learn_bias(a, b, so3_exp(motion.rate_radps * 0.1), 0.001);
  }
  EXPECT_LT((track.bias_radps() - bias_radps).norm(), 5e-4);
  EXPECT_LT(track.bias_sigma_radps(), 0.003);
  const auto measured = track.between({1980 * kStep_ns}, {1990 * kStep_ns});
  ASSERT_TRUE(measured);
  EXPECT_LT(measured->turn.angularDistance(so3_exp(motion.rate_radps * 0.1)), 1e-4);
  const double sigma_radps = track.bias_sigma_radps();
  track.learn_bias({1980 * kStep_ns}, {1990 * kStep_ns}, so3_exp({0.0, 0.0, 1.0}), 0.001);
  EXPECT_LT((track.bias_radps() - bias_radps).norm(), 5e-4)
      << "a wrong registration spoils nothing";
  EXPECT_EQ(track.bias_sigma_radps(), sigma_radps);
}

}  // namespace
}  // namespace glint::slam
