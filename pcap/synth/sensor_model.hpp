// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "pcap/synth/scene.hpp"

namespace glint::synth {

/// Which sensor is simulated.
struct SensorOptions {
  std::string optics = "os1";  ///< "os0" (90 degrees high), "os1" (45), "os2" (22.5).
  int beams = 64;              ///< 16, 32, 64 or 128.
  int columns = 1024;          ///< 512, 1024 or 2048.
  int rate_hz = 10;            ///< 10 or 20.
  LidarProfile profile = LidarProfile::kRng19Rfl8Sig16Nir16;
  std::uint64_t seed = 0;  ///< Of the beam tables' jitter, biases and gains.
};

/// Metadata of such a sensor, with beam tables as irregular as real ones.
/// @throws OptionError naming the option that is not possible and what is.
SensorInfo make_sensor(const SensorOptions& options);

/// What one pixel measures.
struct Measurement {
  std::uint32_t range_mm = 0;
  std::uint16_t signal = 0;
  std::uint16_t reflectivity = 0;
  std::uint16_t near_ir = 0;
};

/// From a ray's hit to what the sensor reports: range noise, bias and steps; photons by albedo,
/// incidence and distance with shot noise; missing returns. Depends on its keys only, not on the
/// order of calls; thread-safe.
class SensorModel {
 public:
  SensorModel(const SensorInfo& info, std::uint64_t seed);

  /// `pixel_key` names the pixel among all of the run; `direction` is the ray's unit vector.
  [[nodiscard]] Measurement measure(const std::optional<Hit>& hit, const Eigen::Vector3d& direction,
                                    int row, std::uint64_t pixel_key) const;
  /// Standard deviation of the range of a return of so many photons, m.
  [[nodiscard]] static double range_sigma_m(double photons);

 private:
  std::uint64_t seed_;
  std::uint32_t range_step_mm_;
  bool wide_reflectivity_;  ///< 16-bit, as legacy firmware has it.
  double photons_at_1m_ = 25'000.0;
  std::vector<double> bias_m_;
  std::vector<double> gain_;
};

}  // namespace glint::synth
