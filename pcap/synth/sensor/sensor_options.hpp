// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>

#include "driver/core/sensor_info.hpp"

namespace glint::synth {

/// Which sensor is simulated.
struct SensorOptions {
  std::string optics = "os1";  ///< "os0" (90 degrees high), "os1" (45), "os2" (22.5).
  int beams = 64;              ///< 16, 32, 64 or 128.
  int columns = 1024;          ///< 512, 1024 or 2048.
  int rate_hz = 10;            ///< 10 or 20.
  LidarProfile profile = LidarProfile::kRng19Rfl8Sig16Nir16;
  std::uint16_t first_frame_id = 1;  ///< Of the first scan; wraps after 65,535.
  ImuProfile imu_profile = ImuProfile::kLegacy;
};

/// How well it measures range and light.
struct NoiseOptions {
  double range_sigma_m = 0.018;      ///< Deviation of the range of a strong return.
  double one_photon_sigma_m = 0.06;  ///< Added in quadrature, divided by the root of the photons.
  double beam_bias_m = 0.0025;       ///< Deviation of the beams' constant range errors.
  double beam_gain = 0.03;           ///< Relative deviation of the beams' sensitivities.
  bool mixed_pixels = true;          ///< Beams have a width, and returns mix at edges.
};

/// The sensor's metadata: beam tables with the irregularities of a real calibration (they follow
/// from the seed), staggering, beam origin offset, transforms of its generation.
/// @throws OptionError naming the option that is not possible and what is.
SensorInfo make_sensor(const SensorOptions& options, std::uint64_t seed);

}  // namespace glint::synth
