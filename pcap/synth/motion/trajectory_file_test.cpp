// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/trajectory_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class TrajectoryFileTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }

  TrajectoryFile load(const std::string& text, double rate_hz = 10.0) {
    std::ofstream(file_) << text;
    return load_trajectory(file_, rate_hz);
  }

  void expect_refused(const std::string& text, const std::string& why) {
    EXPECT_THAT([&] { load(text); },
                ThrowsMessage<InputError>(AllOf(HasSubstr(file_.string()), HasSubstr(why))));
  }

  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      fmt::format("trajectory_{}.txt",
                  testing::UnitTest::GetInstance()->current_test_info()->name());
};

struct TimedPose {
  double time_s;
  Pose pose;
};

// A helix at uneven times that turns more than once round, every other quaternion with its sign
// changed.
std::vector<TimedPose> helix() {
  std::vector<TimedPose> poses;
  double t_s = 0.0;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d turned(0.1 * std::sin(t_s), 0.2 * std::cos(0.7 * t_s), 1.3 * t_s);
    Pose pose{so3_exp(turned), {5 * std::cos(t_s), 5 * std::sin(t_s), 0.3 * t_s}};
    if (i % 2 == 1) pose.rotation.coeffs() *= -1.0;
    poses.push_back({t_s, pose});
    t_s += i % 3 == 0 ? 0.05 : 0.11;
  }
  return poses;
}

std::string tum(const std::vector<TimedPose>& poses, double start_s) {
  std::string text = "# time x y z qx qy qz qw\n\n";
  for (const auto& [t_s, pose] : poses) {
    const Eigen::Vector3d& p = pose.translation_m;
    const Eigen::Quaterniond& q = pose.rotation;
    text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n",
                        start_s + t_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

TEST_F(TrajectoryFileTest, TumPosesAreReproduced) {
  const auto poses = helix();
  const TrajectoryFile read = load(tum(poses, 100.0));
  EXPECT_NEAR(read.duration_s, poses.back().time_s, 1e-9);
  for (const auto& [t_s, pose] : poses) {
    const Pose at = read.motion(t_s);
    EXPECT_NEAR((at.translation_m - pose.translation_m).norm(), 0.0, 1e-9) << t_s;
    EXPECT_NEAR(at.rotation.angularDistance(pose.rotation), 0.0, 1e-9) << t_s;
    EXPECT_NEAR(at.rotation.norm(), 1.0, 1e-12);
  }
}

TEST_F(TrajectoryFileTest, BetweenPosesItIsCloseAndOutsideItStays) {
  const auto poses = helix();
  const TrajectoryFile read = load(tum(poses, 0.0));
  for (double t_s = 0.5; t_s < read.duration_s - 0.5; t_s += 0.013) {
    const Eigen::Vector3d truth(5 * std::cos(t_s), 5 * std::sin(t_s), 0.3 * t_s);
    EXPECT_NEAR((read.motion(t_s).translation_m - truth).norm(), 0.0, 1e-4) << t_s;
  }
  EXPECT_EQ(read.motion(-3.0).translation_m, poses.front().pose.translation_m);
  EXPECT_EQ(read.motion(1e6).translation_m, poses.back().pose.translation_m);
}

TEST_F(TrajectoryFileTest, SecondDerivativesHaveNoJumps) {
  const TrajectoryFile read = load(tum(helix(), 0.0));
  constexpr double kStep_s = 1e-3;
  const auto accelerations = [&](double t_s) {
    const Pose before = read.motion(t_s - kStep_s);
    const Pose here = read.motion(t_s);
    const Pose after = read.motion(t_s + kStep_s);
    Eigen::Matrix<double, 6, 1> both;
    both << before.translation_m + after.translation_m - 2 * here.translation_m,
        so3_log(here.rotation.conjugate() * after.rotation) +
            so3_log(here.rotation.conjugate() * before.rotation);
    return Eigen::Matrix<double, 6, 1>(both / (kStep_s * kStep_s));
  };
  // Their third derivatives are some 10 per second; a kink of the first at a pose would show as a
  // peak of a thousand.
  for (double t_s = 0.01; t_s < read.duration_s - 0.01; t_s += kStep_s) {
    ASSERT_LT((accelerations(t_s + kStep_s) - accelerations(t_s)).norm(), 0.2) << t_s;
  }
}

TEST_F(TrajectoryFileTest, KittiPosesAreReproducedAtTheRate) {
  std::string text;
  const auto poses = helix();
  for (const auto& [t_s, pose] : poses) {
    const Eigen::Matrix3d r = pose.rotation.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}{}", r(row, 0), r(row, 1), r(row, 2),
                          pose.translation_m[row], row < 2 ? " " : "\n");
    }
  }
  const TrajectoryFile read = load(text, 20.0);
  EXPECT_NEAR(read.duration_s, 59 * 0.05, 1e-12);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose at = read.motion(0.05 * static_cast<double>(i));
    EXPECT_NEAR((at.translation_m - poses[i].pose.translation_m).norm(), 0.0, 1e-9);
    EXPECT_NEAR(at.rotation.angularDistance(poses[i].pose.rotation), 0.0, 1e-7);
  }
}

TEST_F(TrajectoryFileTest, RoundedQuaternionsAreTakenAsTheyAreMeant) {
  const TrajectoryFile read = load("0 0 0 0 0 0 0.70 0.71\r\n1 0 0 0 0 0 0.71 0.70 # back\r\n");
  EXPECT_NEAR(read.motion(0.0).rotation.norm(), 1.0, 1e-12);
  EXPECT_NEAR(read.motion(0.5).rotation.angularDistance(
                  Eigen::Quaterniond(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ()))),
              0.0, 1e-3);
}

TEST_F(TrajectoryFileTest, WhatIsWrongIsNamedWithItsLine) {
  const std::string good = "0 0 0 0 0 0 0 1\n";
  expect_refused("", "holds 0 poses");
  expect_refused("# only this\n" + good, "holds 1 poses");
  expect_refused(good + "1 2 3\n", "line 2 holds 3 numbers but the lines before it 8");
  expect_refused("1 2 3\n",
                 "line 1 holds 3 numbers; a TUM trajectory has 8 a line, a KITTI one 12");
  expect_refused(good + "1 x 0 0 0 0 0 1\n", "line 2 holds 'x'");
  expect_refused(good + "1 nan 0 0 0 0 0 1\n", "line 2 holds 'nan'");
  expect_refused(good + "1 0 0 0 1,5 0 0 1\n", "line 2 holds '1,5'");
  expect_refused(good + "1 0 0 0 0.5 0 0 1\n", "line 2 has a quaternion of length 1.118");
  expect_refused(good + "\n" + good, "line 3 is not later");
  expect_refused("1 0 0 0 0 1 0 0 0 0 -1 0\n", "line 1 has a matrix that is no rotation");
  expect_refused("2 0 0 0 0 1 0 0 0 0 1 0\n", "line 1 has a matrix that is no rotation");
}

TEST_F(TrajectoryFileTest, MissingFileAndImpossibleRateAreRefused) {
  EXPECT_THAT([] { load_trajectory("/no/such/path.tum", 10.0); },
              ThrowsMessage<InputError>(HasSubstr("/no/such/path.tum: the file cannot be read")));
  EXPECT_THROW(load("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", 0.0), OptionError);
}

}  // namespace
}  // namespace glint::synth
