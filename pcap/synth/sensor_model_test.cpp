// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor_model.hpp"

#include <gtest/gtest.h>

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

  const SensorInfo info_ = make_sensor({}, 1);
  const NoiseOptions noise_{};
  const SensorModel model_{info_, noise_, 1};
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
    const Measurement m = model_.measure(wall, ahead_, i % 64, static_cast<std::uint64_t>(i));
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
    for (std::uint64_t i = 0; i < 2000; ++i) sum += model_.measure(wall, ahead_, 7, i).signal;
    return sum / 2000.0;
  };
  EXPECT_NEAR(mean_signal(50.0, 0.5F) / mean_signal(100.0, 0.5F), 4.0, 0.3);
  EXPECT_NEAR(mean_signal(30.0, 0.8F) / mean_signal(30.0, 0.2F), 4.0, 0.2);
}

TEST_F(SensorModelTest, FaintReturnsAreMissing) {
  const Sighting wall = wall_at(400.0, 0.1F);
  EXPECT_EQ(model_.measure(wall, ahead_, 0, 1).range_mm, 0U);
  EXPECT_EQ(model_.measure(std::nullopt, ahead_, 0, 1).range_mm, 0U);
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
