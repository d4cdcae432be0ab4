// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/image_projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace glint::slam {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kMetresPerMillimetre = 0.001;
// Rows nearer than this to each other are one.
constexpr double kLeastSpacing_rad = 1e-5;

// Into the image, from no farther than a few turns away.
double wrapped(double column, int columns) {
  while (column < 0.0) column += columns;
  while (column >= columns) column -= columns;
  return column;
}

}  // namespace

ImageProjection::ImageProjection(const SensorInfo& info)
    : columns_(info.columns_per_frame),
      rotation_(info.lidar_to_sensor.topLeftCorner<3, 3>()),
      origin_m_(kMetresPerMillimetre * info.beam_to_lidar(0, 3)) {
  const Eigen::Vector3d origin_mm(0.0, 0.0, info.beam_to_lidar(2, 3));
  const Eigen::Vector3d centre_mm = info.lidar_to_sensor.topRightCorner<3, 1>();
  offset_m_ = kMetresPerMillimetre * (centre_mm + rotation_ * origin_mm);
  rows_.resize(static_cast<std::size_t>(info.pixels_per_column));
  std::iota(rows_.begin(), rows_.end(), 0);
  const auto altitude_deg = [&](int row) {
    return info.beam_altitude_deg[static_cast<std::size_t>(row)];
  };
  std::ranges::stable_sort(rows_, [&](int a, int b) { return altitude_deg(a) > altitude_deg(b); });
  for (const int row : rows_) {
    const auto r = static_cast<std::size_t>(row);
    altitude_rad_.push_back(info.beam_altitude_deg[r] * kRadiansPerDegree);
    shift_.push_back(info.pixel_shift_by_row[r]);
    const double beam_rad = info.beam_azimuth_deg[r] * kRadiansPerDegree;
    zero_column_.push_back(columns_ * (1.0 - beam_rad / kTurn_rad) + shift_.back());
  }
}

// Beams turn clockwise: a larger azimuth comes in an earlier column.
double ImageProjection::column_in(int ordered_row, double azimuth_rad) const {
  const double zero = zero_column_[static_cast<std::size_t>(ordered_row)];
  return wrapped(zero - columns_ * azimuth_rad / kTurn_rad, columns_);
}

ImageProjection::Bearing ImageProjection::bearing_of(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d p = to_lidar(point_m);
  return {std::atan2(p.y(), p.x()), std::atan2(p.z(), p.head<2>().norm() - origin_m_)};
}

bool ImageProjection::place_of(const Bearing& bearing, Place& place) const {
  // The first row that is not above it.
  const auto below =
      std::ranges::lower_bound(altitude_rad_, bearing.altitude_rad, std::greater<>{});
  if (below == altitude_rad_.begin() || below == altitude_rad_.end()) return false;
  const double above_rad = *(below - 1);
  const double spacing_rad = above_rad - *below;
  place.azimuth_rad = bearing.azimuth_rad;
  place.row = static_cast<int>(below - altitude_rad_.begin()) - 1;
  place.share_below =
      spacing_rad > kLeastSpacing_rad ? (above_rad - bearing.altitude_rad) / spacing_rad : 0.0;
  return true;
}

bool ImageProjection::project(const Eigen::Vector3d& point_m, Place& place) const {
  return place_of(bearing_of(point_m), place);
}

int ImageProjection::column_at(const Place& place) const {
  const int row = place.share_below < 0.5 ? place.row : place.row + 1;
  const int shift = shift_[static_cast<std::size_t>(row)];
  const double staggered = column_in(row, place.azimuth_rad) - shift;
  return static_cast<int>(std::lround(wrapped(staggered, columns_))) % columns_;
}

ImageProjection::Line ImageProjection::in_row(const Image<std::uint8_t>& image, int ordered_row,
                                              double azimuth_rad) const {
  const double column = column_in(ordered_row, azimuth_rad);
  const int left = static_cast<int>(column);
  const auto share = static_cast<float>(column - left);
  const auto pixels = image.row(rows_[static_cast<std::size_t>(ordered_row)]);
  const auto at = [&](int u) {
    return static_cast<float>(pixels[static_cast<std::size_t>((u + columns_) % columns_)]);
  };
  const float a = at(left);
  const float b = at(left + 1);
  // Of central differences, which noise reaches less.
  const float slope = 0.5F * ((1.0F - share) * (b - at(left - 1)) + share * (at(left + 2) - a));
  return {a + share * (b - a), slope};
}

bool ImageProjection::values_between(const Image<std::uint8_t>& image,
                                     const Eigen::Vector3d& first_m, const Eigen::Vector3d& last_m,
                                     std::span<float> values) const {
  const Bearing first = bearing_of(first_m);
  const Bearing last = bearing_of(last_m);
  const double turn_rad = std::remainder(last.azimuth_rad - first.azimuth_rad, kTurn_rad);
  const double rise_rad = last.altitude_rad - first.altitude_rad;
  Place place;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(values.size() - 1);
    const Bearing bearing{first.azimuth_rad + share * turn_rad,
                          first.altitude_rad + share * rise_rad};
    if (!place_of(bearing, place)) return false;
    const float above = in_row(image, place.row, bearing.azimuth_rad).value;
    const float below = in_row(image, place.row + 1, bearing.azimuth_rad).value;
    values[i] = above + static_cast<float>(place.share_below) * (below - above);
  }
  return true;
}

bool ImageProjection::sample(const Image<std::uint8_t>& image, const Eigen::Vector3d& point_m,
                             Sample& sample) const {
  Place place;
  if (!project(point_m, place)) return false;
  const Line above = in_row(image, place.row, place.azimuth_rad);
  const Line below = in_row(image, place.row + 1, place.azimuth_rad);
  const auto share = static_cast<float>(place.share_below);
  sample.value = above.value + share * (below.value - above.value);
  const double slope = above.slope + share * (below.slope - above.slope);
  const auto row = static_cast<std::size_t>(place.row);
  const double by_azimuth = -slope * columns_ / kTurn_rad;
  const double by_altitude =
      (above.value - below.value) /
      std::max(kLeastSpacing_rad, altitude_rad_[row] - altitude_rad_[row + 1]);
  const Eigen::Vector3d p = to_lidar(point_m);
  const double flat2 = std::max(1e-6, p.head<2>().squaredNorm());
  const double flat = std::sqrt(flat2);
  const double range2 = flat2 + p.z() * p.z();
  const Eigen::Vector3d azimuth_by_point(-p.y() / flat2, p.x() / flat2, 0.0);
  const Eigen::Vector3d altitude_by_point =
      Eigen::Vector3d(-p.x() * p.z() / flat, -p.y() * p.z() / flat, flat) / range2;
  sample.gradient =
      (rotation_ * (by_azimuth * azimuth_by_point + by_altitude * altitude_by_point)).cast<float>();
  return true;
}

double ImageProjection::range_near_m(const Image<std::uint32_t>& range_mm,
                                     const Eigen::Vector3d& point_m) const {
  Place place;
  if (!project(point_m, place)) return 0.0;
  const int row = place.share_below < 0.5 ? place.row : place.row + 1;
  const int column = static_cast<int>(std::lround(column_in(row, place.azimuth_rad))) % columns_;
  return kMetresPerMillimetre * range_mm(rows_[static_cast<std::size_t>(row)], column);
}

}  // namespace glint::slam
