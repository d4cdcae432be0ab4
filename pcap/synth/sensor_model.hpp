// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "pcap/synth/scene.hpp"
#include "pcap/synth/sensor_options.hpp"

namespace glint::synth {

/// What one pixel measures.
struct Measurement {
  std::uint32_t range_mm = 0;
  std::uint16_t signal = 0;
  std::uint16_t reflectivity = 0;
  std::uint16_t near_ir = 0;
};

/// From what a ray meets to what the sensor reports: range noise, bias and steps; photons by
/// albedo, incidence and distance with shot noise and saturation; missing returns. Depends on its
/// arguments only; thread-safe.
class SensorModel {
 public:
  SensorModel(const SensorInfo& info, const NoiseOptions& noise, std::uint64_t seed);

  /// `pixel_key` names the pixel among all of the run; `direction` is the ray's unit vector.
  [[nodiscard]] Measurement measure(const std::optional<Sighting>& sighting,
                                    const Eigen::Vector3d& direction, int row,
                                    std::uint64_t pixel_key) const;
  /// Deviation of the range of a return of so many photons, m, without the beams' biases.
  [[nodiscard]] double range_sigma_m(double photons) const;

 private:
  std::uint64_t seed_;
  NoiseOptions noise_;
  double range_step_mm_;
  bool wide_reflectivity_;  ///< 16 bits, as legacy firmware has it.
  double photons_;          ///< Off a white surface square to the beam, times m^2.
  double near_range_m_;     ///< Nearer than about this the optics collect no more light.
  std::vector<double> bias_m_;
  std::vector<double> gain_;
};

}  // namespace glint::synth
