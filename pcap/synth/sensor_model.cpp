// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "driver/core/packet_format.hpp"
#include "pcap/synth/option_error.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

struct Optics {
  const char* name;
  const char* product_line;
  double vertical_fov_deg;
  double beam_origin_mm;
  double photons_at_1m;  // Of a white surface square to the beam.
};
constexpr std::array<Optics, 3> kOptics = {{{"os0", "OS-0", 90.0, 27.67, 12'000.0},
                                            {"os1", "OS-1", 45.0, 15.806, 25'000.0},
                                            {"os2", "OS-2", 22.5, 13.762, 60'000.0}}};
// Horizontal angles of four neighbouring beams, which are built as one stack.
constexpr std::array<double, 4> kAzimuth_deg = {4.2, 1.4, -1.4, -4.2};

constexpr double kNoise_m = 0.007;          // Of a bright return.
constexpr double kPhotonNoise_m = 0.14;     // Times one over the root of the photons.
constexpr double kBias_m = 0.002;           // Spread of the beams' fixed biases.
constexpr double kGainSpread = 0.04;        // Of the beams' sensitivities: line artefacts.
constexpr double kFewestPhotons = 7.0;      // Below this a return is lost in the noise.
constexpr double kFocus_m = 1.2;            // Nearer than this less of the light is collected.
constexpr double kDivergence_rad = 0.0035;  // Full width of the beam.
constexpr double kAmbientPhotons = 160.0;

template <class T>
void require(T value, std::initializer_list<T> possible, const char* what) {
  if (std::find(possible.begin(), possible.end(), value) != possible.end()) return;
  std::string list;
  for (const T& p : possible) list += fmt::format("{}{}", list.empty() ? "" : ", ", p);
  throw OptionError(fmt::format("cannot simulate {} {}: choose one of {}", what, value, list));
}

const Optics& optics_of(const std::string& name) {
  for (const Optics& optics : kOptics) {
    if (name == optics.name) return optics;
  }
  throw OptionError(fmt::format("unknown sensor '{}': choose os0, os1 or os2", name));
}

// Mean albedo over the beam's footprint, which grazing incidence draws out.
double footprint_albedo(const Hit& hit, double cosine) {
  const double half_m = 0.25 * kDivergence_rad * hit.distance_m;
  const double long_m = std::min(half_m / std::max(cosine, 0.05), 10.0 * half_m);
  return hit.quad->texture->albedo(hit.u_m, hit.v_m, long_m, half_m);
}

std::uint16_t counted(double photons) {
  return static_cast<std::uint16_t>(std::clamp(std::round(photons), 0.0, 65535.0));
}

}  // namespace

SensorInfo make_sensor(const SensorOptions& options) {
  const Optics& optics = optics_of(options.optics);
  require(options.beams, {16, 32, 64, 128}, "--beams");
  require(options.columns, {512, 1024, 2048}, "--columns");
  require(options.rate_hz, {10, 20}, "--rate");
  SensorInfo info;
  info.product_line = fmt::format("{}-{}", optics.product_line, options.beams);
  info.serial_number = "100000000001";
  info.firmware = options.profile == LidarProfile::kLegacy ? "v1.14.0" : "v2.5.3";
  info.lidar_mode = fmt::format("{}x{}", options.columns, options.rate_hz);
  info.init_id = options.profile == LidarProfile::kLegacy ? 0 : 5'390'293;
  info.profile = options.profile;
  info.columns_per_frame = options.columns;
  info.columns_per_packet = 16;
  info.pixels_per_column = options.beams;
  info.scan_rate_hz = options.rate_hz;
  info.column_window = {0, options.columns - 1};

  Random random{options.seed, 0x5E4504ULL};
  for (int row = 0; row < options.beams; ++row) {
    const double share = options.beams > 1 ? row / (options.beams - 1.0) : 0.5;
    const double step_deg = optics.vertical_fov_deg / options.beams;
    info.beam_altitude_deg.push_back((0.5 - share) * optics.vertical_fov_deg +
                                     0.05 * step_deg * random.gaussian());
    const double azimuth_deg =
        kAzimuth_deg[static_cast<std::size_t>(row % 4)] + 0.02 * random.gaussian();
    info.beam_azimuth_deg.push_back(azimuth_deg);
    info.pixel_shift_by_row.push_back(
        static_cast<int>(std::lround(azimuth_deg * options.columns / 360.0)));
  }
  info.beam_to_lidar(0, 3) = optics.beam_origin_mm;
  info.lidar_to_sensor(0, 0) = info.lidar_to_sensor(1, 1) = -1.0;
  info.lidar_to_sensor(2, 3) = 38.195;
  info.imu_to_sensor.topRightCorner<3, 1>() = Eigen::Vector3d(-2.441, -9.725, 7.533);
  return info;
}

SensorModel::SensorModel(const SensorInfo& info, std::uint64_t seed)
    : seed_(seed),
      range_step_mm_(
          static_cast<std::uint32_t>(profile_layout(info.profile).field(Channel::kRange).scale)),
      wide_reflectivity_(info.profile == LidarProfile::kLegacy) {
  Random random{seed, 0xB1A5ULL};
  for (int row = 0; row < info.pixels_per_column; ++row) {
    bias_m_.push_back(kBias_m * random.gaussian());
    gain_.push_back(1.0 + kGainSpread * random.gaussian());
  }
  for (const Optics& optics : kOptics) {
    if (info.product_line.starts_with(optics.product_line)) photons_at_1m_ = optics.photons_at_1m;
  }
}

double SensorModel::range_sigma_m(double photons) {
  return std::hypot(kNoise_m, kPhotonNoise_m / std::sqrt(std::max(1.0, photons)));
}

Measurement SensorModel::measure(const std::optional<Hit>& hit, const Eigen::Vector3d& direction,
                                 int row, std::uint64_t pixel_key) const {
  Random random{seed_, pixel_key};
  const auto beam = static_cast<std::size_t>(row);
  Measurement m;
  const double cosine = hit ? std::abs(direction.dot(hit->normal)) : 0.0;
  const double albedo = hit ? footprint_albedo(*hit, cosine) : 0.0;
  const double ambient = kAmbientPhotons * (0.1 + albedo) * gain_[beam];
  m.near_ir = counted(ambient + std::sqrt(ambient) * random.gaussian());
  if (!hit) return m;

  const double r_m = hit->distance_m;
  const double collected = 1.0 / (1.0 + std::pow(kFocus_m / r_m, 4.0));
  const double expected = photons_at_1m_ * albedo * cosine * collected * gain_[beam] / (r_m * r_m);
  const double photons = std::max(0.0, expected + std::sqrt(expected) * random.gaussian());
  const double noise = random.gaussian();
  if (photons < kFewestPhotons) return m;
  m.signal = counted(photons);
  const double range_mm = 1000.0 * (r_m + bias_m_[beam] + range_sigma_m(expected) * noise);
  const double step = range_step_mm_;
  m.range_mm = static_cast<std::uint32_t>(std::max(0.0, std::round(range_mm / step) * step));
  // Calibrated reflectivity is 100 for a diffuse white surface; old firmware scaled it otherwise.
  const double reflectivity = 100.0 * albedo * gain_[beam] * photons / std::max(1.0, expected);
  m.reflectivity =
      wide_reflectivity_ ? counted(20.0 * reflectivity) : counted(std::min(255.0, reflectivity));
  return m;
}

}  // namespace glint::synth
