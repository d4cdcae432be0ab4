// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "driver/core/packet_format.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

// Fitted by eye to the photons by distance in real captures of an OS1-64 in a street and indoors
// and of an OS2-128: they fall with the square of the range only beyond near_range_m.
struct Receiver {
  std::string_view product_line;
  double photons;
  double near_range_m;
};
constexpr std::array<Receiver, 3> kReceivers = {
    {{"OS-0", 90'000.0, 7.0}, {"OS-1", 250'000.0, 12.0}, {"OS-2", 800'000.0, 25.0}}};

constexpr double kBeamWidthRad = 0.0031;
// Fewer photons are lost in the background.
constexpr double kFewestPhotons = 5.0;
constexpr double kShortestRangeM = 0.3;
// Counters bend before they end.
constexpr double kBendPhotons = 8000.0;
constexpr double kMostPhotons = 4095.0;
// Speckle and pulse-to-pulse variation, relative.
constexpr double kSpeckle = 0.03;
// Legacy firmware's uncalibrated scale per per cent of reflectivity.
constexpr double kLegacyReflectivity = 20.0;

std::uint16_t counted(double photons) {
  return static_cast<std::uint16_t>(std::clamp(std::round(photons), 0.0, 65535.0));
}

}  // namespace

SensorModel::SensorModel(const SensorInfo& info, const NoiseOptions& noise, std::uint64_t seed)
    : seed_(seed),
      noise_(noise),
      range_step_mm_(profile_layout(info.profile).field(Channel::kRange).scale),
      wide_reflectivity_(info.profile == LidarProfile::kLegacy),
      photons_(kReceivers[1].photons),
      near_range_m_(kReceivers[1].near_range_m) {
  for (const Receiver& receiver : kReceivers) {
    if (!info.product_line.starts_with(receiver.product_line)) continue;
    photons_ = receiver.photons;
    near_range_m_ = receiver.near_range_m;
  }
  Random random{seed, 0xB1A5ULL};
  for (int row = 0; row < info.pixels_per_column; ++row) {
    bias_m_.push_back(noise.beam_bias_m * random.gaussian());
    gain_.push_back(std::max(0.5, 1.0 + noise.beam_gain * random.gaussian()));
  }
  // What all beams have in common a calibration would have removed.
  const double common_m =
      std::accumulate(bias_m_.begin(), bias_m_.end(), 0.0) / static_cast<double>(bias_m_.size());
  for (double& bias_m : bias_m_) bias_m -= common_m;
}

double SensorModel::range_sigma_m(double photons) const {
  return std::hypot(noise_.range_sigma_m,
                    noise_.one_photon_sigma_m / std::sqrt(std::max(1.0, photons)));
}

Measurement SensorModel::measure(const std::optional<Sighting>& sighting,
                                 const Eigen::Vector3d& direction, int row,
                                 std::uint64_t pixel_key) const {
  if (!sighting) return {};
  Random random{seed_, pixel_key};
  const auto beam = static_cast<std::size_t>(row);
  const Hit& hit = sighting->hit;
  const double range_m = hit.distance_m;
  const double cosine = std::abs(direction.dot(hit.normal));
  // Grazing incidence draws the footprint out one way: take its mean size.
  const double footprint_m = kBeamWidthRad * range_m / std::sqrt(std::max(cosine, 0.01));
  const double albedo = sighting->surface->albedo->sample(hit.u_m, hit.v_m, footprint_m);

  Measurement m;
  const double ambient = sighting->surface->ambient_photons * (0.1 + albedo) * gain_[beam];
  m.near_ir = counted(ambient + std::sqrt(ambient) * random.gaussian());

  // Lambert's law, the inverse square beyond the near range, shot noise.
  const double collected = photons_ / (range_m * range_m + near_range_m_ * near_range_m_);
  const double expected = collected * albedo * cosine * gain_[beam];
  const double photons =
      expected + std::hypot(std::sqrt(expected), kSpeckle * expected) * random.gaussian();
  m.signal =
      counted(std::min(kMostPhotons, photons / (1.0 + std::max(0.0, photons) / kBendPhotons)));
  if (photons < kFewestPhotons || range_m < kShortestRangeM) return m;

  const double range_mm =
      1000.0 * (range_m + bias_m_[beam] + range_sigma_m(photons) * random.gaussian());
  m.range_mm = static_cast<std::uint32_t>(
      std::max(0.0, std::round(range_mm / range_step_mm_) * range_step_mm_));
  // Calibrated reflectivity is 100 for a white surface square to the beam.
  const double reflectivity = 100.0 * photons / collected;
  m.reflectivity = wide_reflectivity_ ? counted(kLegacyReflectivity * reflectivity)
                                      : counted(std::min(255.0, reflectivity));
  return m;
}

}  // namespace glint::synth
