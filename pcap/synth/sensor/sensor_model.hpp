// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "pcap/synth/scene/scene.hpp"
#include "pcap/synth/sensor/sensor_options.hpp"

namespace glint::synth {

class Random;

/// A part of a beam: its share of the light, its unit direction and what it falls on.
struct BeamPart {
  double share = 1.0;  ///< Of a beam in parts; one that is whole ignores it.
  Eigen::Vector3d direction;
  Sighting sighting;
};

/// One return: what the sensor reports of it, and whether it came off a moving thing. Range 0:
/// none.
struct Return {
  std::uint32_t range_mm = 0;
  std::uint16_t signal = 0;
  std::uint16_t reflectivity = 0;
  bool moving = false;
};

/// What one pixel measures: the strongest return first, the second where the profile has one.
struct Measurement {
  std::array<Return, 2> returns;
  std::uint16_t near_ir = 0;
};

/// From what a beam meets to what the sensor reports: photons by albedo, incidence and distance
/// with shot noise and saturation; parts of the beam at nearly one distance run together into one
/// return (a mixed pixel), others into further ones; missing returns; range noise, bias and steps.
/// Depends on its arguments only; thread-safe.
class SensorModel {
 public:
  /// Parts of a beam that falls on more than one thing.
  static constexpr int kParts = 5;

  SensorModel(const SensorInfo& info, const NoiseOptions& noise, std::uint64_t seed);

  /// How far a beam reaches to the side of its middle, rad; 0 when mixed pixels are off.
  [[nodiscard]] double beam_rad() const { return beam_rad_; }
  /// The directions and shares of a beam's parts around its middle, which stays the first.
  void split(const Eigen::Vector3d& direction, std::span<BeamPart, kParts> parts) const;

  /// `pixel_key` names the pixel among all of the run; `parts` are the beam's, the middle first.
  [[nodiscard]] Measurement measure(std::span<const BeamPart> parts, int row,
                                    std::uint64_t pixel_key) const;
  /// Deviation of the range of a return of so many photons, m, without the beams' biases.
  [[nodiscard]] double range_sigma_m(double photons) const;

 private:
  struct Echo {
    double photons;  ///< Expected.
    double range_m;  ///< Mean of what it is made of, by photons.
    bool moving;
  };
  using Echoes = std::array<Echo, kParts>;

  /// What a beam brings back.
  struct Light {
    Echoes echoes;  ///< The first `count` mean something.
    int count = 0;
    double ambient = 0.0;  ///< Near-infrared photons.
  };

  [[nodiscard]] Light gather(std::span<const BeamPart> parts, double gain) const;
  static int merge(Echoes& echoes, int count);
  /// Photons off a white surface square to the beam.
  [[nodiscard]] double collected(double range_m) const;
  [[nodiscard]] Return report(const Echo& echo, int row, Random& random) const;

  std::uint64_t seed_;
  NoiseOptions noise_;
  double range_step_mm_;
  double longest_mm_;       ///< That the profile can tell.
  bool wide_reflectivity_;  ///< 16 bits, as legacy firmware has it.
  bool dual_;
  double beam_rad_;
  double photons_;       ///< Off a white surface square to the beam, times m^2.
  double near_range_m_;  ///< Nearer than about this the optics collect no more light.
  std::vector<double> bias_m_;
  std::vector<double> gain_;
};

}  // namespace glint::synth
