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
  Hit wall_at(double distance_m, double albedo) {
    Texture::Base base;
    base.albedo = albedo;
    base.blotch_contrast = 0.0;
    quad_.texture = std::make_shared<const Texture>(base);
    quad_.width_m = quad_.height_m = 100.0;
    return {distance_m, -Eigen::Vector3d::UnitX(), &quad_, 50.0, 50.0};
  }

  const SensorInfo info_ = make_sensor({});
  const SensorModel model_{info_, 1};
  const Eigen::Vector3d ahead_ = Eigen::Vector3d::UnitX();
  Quad quad_;
};

TEST_F(SensorModelTest, RangesScatterAsConfiguredRoundTheTruth) {
  const Hit hit = wall_at(6.0, 0.5);
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  double photons = 0.0;
  constexpr int kPixels = 20000;
  for (int i = 0; i < kPixels; ++i) {
    const Measurement m = model_.measure(hit, ahead_, i % 64, static_cast<std::uint64_t>(i));
    const double error_m = 0.001 * m.range_mm - 6.0;
    sum_m += error_m;
    squares_m2 += error_m * error_m;
    photons += m.signal;
  }
  const double sigma_m = std::sqrt(squares_m2 / kPixels);
  const double expected_m = SensorModel::range_sigma_m(photons / kPixels);
  EXPECT_NEAR(sum_m / kPixels, 0.0, 0.001);
  EXPECT_NEAR(sigma_m, std::hypot(expected_m, 0.002), 0.1 * expected_m);
}

TEST_F(SensorModelTest, SignalFallsWithTheSquareOfTheDistanceAndWithAlbedo) {
  const auto mean_signal = [&](double distance_m, double albedo) {
    const Hit hit = wall_at(distance_m, albedo);
    double sum = 0.0;
    for (std::uint64_t i = 0; i < 2000; ++i) sum += model_.measure(hit, ahead_, 7, i).signal;
    return sum / 2000.0;
  };
  EXPECT_NEAR(mean_signal(5.0, 0.5) / mean_signal(10.0, 0.5), 4.0, 0.15);
  EXPECT_NEAR(mean_signal(5.0, 0.8) / mean_signal(5.0, 0.2), 4.0, 0.15);
}

TEST_F(SensorModelTest, FaintReturnsAreMissing) {
  const Hit hit = wall_at(90.0, 0.1);
  EXPECT_EQ(model_.measure(hit, ahead_, 0, 1).range_mm, 0U);
  EXPECT_EQ(model_.measure(std::nullopt, ahead_, 0, 1).range_mm, 0U);
}

TEST(MakeSensor, ImpossibleSensorsAreRefusedWithWhatIsPossible) {
  try {
    make_sensor({.beams = 40});
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("16, 32, 64, 128"), std::string::npos) << error.what();
  }
  EXPECT_THROW(make_sensor({.optics = "os7"}), OptionError);
}

}  // namespace
}  // namespace glint::synth
