// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/sensor_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

class SensorModelTest : public testing::Test {
 protected:
  // A wall of even albedo, seen square at a distance.
  Sighting wall_at(double distance_m, float albedo) {
    wall_.albedo = std::make_shared<const AlbedoMap>(Canvas(10.0, 10.0, 0.1, albedo));
    return {{distance_m, -Eigen::Vector3d::UnitX(), 5.0, 5.0}, &wall_};
  }
  // The strongest return of a beam that falls on one thing only.
  Return measure(const Sighting& sighting, int row, std::uint64_t key) const {
    const BeamPart part{1.0, ahead_, sighting};
    return model_.measure({&part, 1}, row, key).returns[0];
  }
  // A beam of which the parts from `first` on fall on the wall at `far_m`, the others at `near_m`.
  std::array<BeamPart, SensorModel::kParts> parted(double near_m, double far_m, std::size_t first) {
    std::array<BeamPart, SensorModel::kParts> parts;
    dual_model_.split(ahead_, parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i].sighting = wall_at(i < first ? near_m : far_m, 0.5F);
    }
    return parts;
  }

  const SensorInfo info_ = make_sensor({}, 1);
  const SensorInfo dual_info_ = make_sensor({.profile = LidarProfile::kRng19Rfl8Sig16Nir16Dual}, 1);
  const NoiseOptions noise_{};
  const SensorModel model_{info_, noise_, 1};
  const SensorModel dual_model_{dual_info_, noise_, 1};
  const Eigen::Vector3d ahead_ = Eigen::Vector3d::UnitX();
  Surface wall_;
};

TEST_F(SensorModelTest, RangesScatterAsConfiguredRoundTheTruth) {
  const Sighting wall = wall_at(6.0, 0.5F);
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  double photons = 0.0;
  constexpr int kPixels = 20000;
  for (int i = 0; i < kPixels; ++i) {
    const Return m = measure(wall, i % 64, static_cast<std::uint64_t>(i));
    const double error_m = 0.001 * m.range_mm - 6.0;
    sum_m += error_m;
    squares_m2 += error_m * error_m;
    photons += m.signal;
  }
  const double sigma_m = std::sqrt(squares_m2 / kPixels);
  const double expected_m = model_.range_sigma_m(photons / kPixels);
  EXPECT_NEAR(sum_m / kPixels, 0.0, 0.001);
  EXPECT_NEAR(sigma_m, std::hypot(expected_m, noise_.beam_bias_m), 0.1 * expected_m);
}

TEST_F(SensorModelTest, SignalFallsWithTheSquareOfTheFarDistanceAndWithAlbedo) {
  const auto mean_signal = [&](double distance_m, float albedo) {
    const Sighting wall = wall_at(distance_m, albedo);
    double sum = 0.0;
    for (std::uint64_t i = 0; i < 2000; ++i) sum += measure(wall, 7, i).signal;
    return sum / 2000.0;
  };
  EXPECT_NEAR(mean_signal(50.0, 0.5F) / mean_signal(100.0, 0.5F), 4.0, 0.3);
  EXPECT_NEAR(mean_signal(30.0, 0.8F) / mean_signal(30.0, 0.2F), 4.0, 0.2);
}

TEST_F(SensorModelTest, FaintReturnsAreMissing) {
  EXPECT_EQ(measure(wall_at(400.0, 0.1F), 0, 1).range_mm, 0U);
  EXPECT_EQ(measure({}, 0, 1).range_mm, 0U);
}

TEST_F(SensorModelTest, SurfacesCloseTogetherMixIntoOneReturnBetweenThem) {
  const auto parts = parted(10.0, 10.3, 1);  // Half of the light each.
  double sum_m = 0.0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Measurement m = dual_model_.measure(parts, static_cast<int>(i % 64), i);
    sum_m += 0.001 * m.returns[0].range_mm;
    EXPECT_EQ(m.returns[1].range_mm, 0U);
  }
  EXPECT_NEAR(sum_m / 2000.0, 10.15, 0.01);
}

TEST_F(SensorModelTest, SurfacesFarApartAreTwoReturnsTheStrongerFirst) {
  const auto near_first = parted(10.0, 14.0, 3);
  const auto far_first = parted(10.0, 11.0, 0);
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Measurement m = dual_model_.measure(near_first, 3, i);
    EXPECT_NEAR(0.001 * m.returns[0].range_mm, 10.0, 0.1);
    EXPECT_NEAR(0.001 * m.returns[1].range_mm, 14.0, 0.1);
    EXPECT_GT(m.returns[0].signal, m.returns[1].signal);
    EXPECT_NEAR(0.001 * dual_model_.measure(far_first, 3, i).returns[0].range_mm, 11.0, 0.1);
    // A profile of one return leaves the weaker out.
    EXPECT_EQ(model_.measure(near_first, 3, i).returns[1].range_mm, 0U);
  }
}

TEST_F(SensorModelTest, ABeamsPartsShareAllOfItsLightRoundItsMiddle) {
  std::array<BeamPart, SensorModel::kParts> parts;
  const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  model_.split(direction, parts);
  double share = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const BeamPart& part : parts) {
    share += part.share;
    mean += part.share * part.direction;
    EXPECT_LE(std::acos(std::min(1.0, part.direction.dot(direction))), 1.001 * model_.beam_rad());
  }
  EXPECT_NEAR(share, 1.0, 1e-12);
  EXPECT_LT((mean.normalized() - direction).norm(), 1e-9);
}

TEST(MakeSensor, ImpossibleSensorsAreRefusedWithWhatIsPossible) {
  try {
    make_sensor({.beams = 40}, 1);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("16, 32, 64, 128"), std::string::npos) << error.what();
  }
  EXPECT_THROW(make_sensor({.optics = "os7"}, 1), OptionError);
}

}  // namespace
}  // namespace glint::synth
