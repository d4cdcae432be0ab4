// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/sensor_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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

// Half the beam's light is within this angle across.
constexpr double kBeamWidthRad = 0.0031;
// The beam's cross-section is a bell of this deviation.
constexpr double kBeamSigmaRad = kBeamWidthRad / 2.355;
// A point in the middle and four round it at two deviations integrate over a bell to the third
// degree with these shares (Stroud, "Approximate calculation of multiple integrals", 1971).
constexpr double kMiddleShare = 0.5;
constexpr double kRingShare = 0.125;
// Light that comes back within this distance makes one return.
constexpr double kPulseM = 0.35;
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
// Near-infrared photons where there is nothing but air.
constexpr double kAirPhotons = 8.0;

std::uint16_t counted(double photons) {
  return static_cast<std::uint16_t>(std::clamp(photons, 0.0, 65535.0) + 0.5);
}

}  // namespace

SensorModel::SensorModel(const SensorInfo& info, const NoiseOptions& noise, std::uint64_t seed)
    : seed_(seed),
      noise_(noise),
      range_step_mm_(profile_layout(info.profile).field(Channel::kRange).scale),
      longest_mm_(range_step_mm_ *
                  ((1U << profile_layout(info.profile).field(Channel::kRange).width_bits) - 1U)),
      wide_reflectivity_(info.profile == LidarProfile::kLegacy),
      dual_(profile_layout(info.profile).field(Channel::kRange2).present()),
      beam_rad_(noise.mixed_pixels ? 2.0 * kBeamSigmaRad : 0.0),
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
  return std::sqrt(noise_.range_sigma_m * noise_.range_sigma_m +
                   noise_.one_photon_sigma_m * noise_.one_photon_sigma_m / std::max(1.0, photons));
}

void SensorModel::split(const Eigen::Vector3d& direction, std::span<BeamPart, kParts> parts) const {
  const Eigen::Vector3d across = direction.unitOrthogonal();
  const Eigen::Vector3d up = direction.cross(across);
  parts[0].direction = direction;
  parts[0].share = kMiddleShare;
  for (std::size_t i = 1; i < kParts; ++i) {
    const double turn_rad = std::numbers::pi / 2.0 * static_cast<double>(i);
    parts[i].direction =
        (direction + beam_rad_ * (std::cos(turn_rad) * across + std::sin(turn_rad) * up))
            .normalized();
    parts[i].share = kRingShare;
  }
}

double SensorModel::collected(double range_m) const {
  return photons_ / (range_m * range_m + near_range_m_ * near_range_m_);
}

// Lambert's law, and the inverse square beyond the near range.
SensorModel::Light SensorModel::gather(std::span<const BeamPart> parts, double gain) const {
  Light light;
  Echoes& echoes = light.echoes;
  int& count = light.count;
  const double width_rad = parts.size() == 1 ? kBeamWidthRad : kBeamSigmaRad;
  for (const BeamPart& part : parts) {
    const double share = parts.size() == 1 ? 1.0 : part.share;
    const Sighting& seen = part.sighting;
    if (seen.surface == nullptr) {
      light.ambient += share * kAirPhotons;
      continue;
    }
    const double range_m = seen.hit.distance_m;
    const double cosine = std::abs(part.direction.dot(seen.hit.normal));
    // Grazing incidence draws the footprint out one way: take its mean size.
    const double footprint_m = width_rad * range_m / std::sqrt(std::max(cosine, 0.01));
    const double albedo = seen.surface->albedo->sample(seen.hit.u_m, seen.hit.v_m, footprint_m);
    light.ambient += share * gain * seen.surface->ambient_photons * (0.1 + albedo);
    const double photons = share * gain * collected(range_m) * albedo * cosine;
    echoes[static_cast<std::size_t>(count++)] = {photons, range_m, seen.moving};
  }
  if (count > 1) count = merge(echoes, count);
  return light;
}

// Echoes that follow each other closely become one; the strongest goes first.
int SensorModel::merge(Echoes& echoes, int count) {
  std::sort(echoes.begin(), echoes.begin() + count,
            [](const Echo& a, const Echo& b) { return a.range_m < b.range_m; });
  std::size_t last = 0;
  double reaches_m = echoes[0].range_m;
  for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i) {
    const Echo next = echoes[i];
    if (next.range_m - reaches_m > kPulseM) {
      echoes[++last] = next;
    } else {
      Echo& echo = echoes[last];
      const double sum = std::max(1e-9, echo.photons + next.photons);
      echo.range_m = (echo.photons * echo.range_m + next.photons * next.range_m) / sum;
      echo.moving = next.photons > echo.photons ? next.moving : echo.moving;
      echo.photons = sum;
    }
    reaches_m = next.range_m;
  }
  const auto merged = static_cast<int>(last) + 1;
  std::sort(echoes.begin(), echoes.begin() + merged,
            [](const Echo& a, const Echo& b) { return a.photons > b.photons; });
  return merged;
}

Return SensorModel::report(const Echo& echo, int row, Random& random) const {
  Return reported;
  const double deviation =
      std::sqrt(echo.photons + kSpeckle * kSpeckle * echo.photons * echo.photons);
  const double photons = echo.photons + deviation * random.quick_gaussian();
  reported.signal =
      counted(std::min(kMostPhotons, photons / (1.0 + std::max(0.0, photons) / kBendPhotons)));
  if (photons < kFewestPhotons || echo.range_m < kShortestRangeM) return reported;

  const double range_mm = 1000.0 * (echo.range_m + bias_m_[static_cast<std::size_t>(row)] +
                                    range_sigma_m(photons) * random.quick_gaussian());
  const double steps_mm = std::floor(range_mm / range_step_mm_ + 0.5) * range_step_mm_;
  if (steps_mm < 0.0 || steps_mm > longest_mm_) return reported;
  reported.range_mm = static_cast<std::uint32_t>(steps_mm);
  // Calibrated reflectivity is 100 for a white surface square to the beam.
  const double reflectivity = 100.0 * photons / collected(echo.range_m);
  reported.reflectivity = wide_reflectivity_ ? counted(kLegacyReflectivity * reflectivity)
                                             : counted(std::min(255.0, reflectivity));
  reported.moving = echo.moving;
  return reported;
}

Measurement SensorModel::measure(std::span<const BeamPart> parts, int row,
                                 std::uint64_t pixel_key) const {
  Random random{seed_, pixel_key};
  const Light light = gather(parts, gain_[static_cast<std::size_t>(row)]);
  Measurement measured;
  measured.near_ir = counted(light.ambient + std::sqrt(light.ambient) * random.quick_gaussian());
  const int count = std::min(light.count, dual_ ? 2 : 1);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    measured.returns[i] = report(light.echoes[i], row, random);
  }
  return measured;
}

}  // namespace glint::synth
