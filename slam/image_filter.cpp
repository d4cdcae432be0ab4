// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/image_filter.hpp"

#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

constexpr double kWindowAzimuth_deg = 15.0;
constexpr double kWindowElevation_deg = 5.0;
constexpr float kMiddle = 128.0F;
// Grey levels of one deviation: five take all there are.
constexpr float kContrast = 40.0F;
// Contrast counts as such from so many deviations of the noise on; weaker one stays weak.
constexpr float kNoiseDeviations = 5.0F;
// Intensity is counted in quarters: of sensors that tell a few units only, a beam's factor would
// be lost to rounding.
constexpr float kLevelsPerUnit = 4.0F;

// Neighbours are on one surface if their ranges differ by less than this share.
constexpr float kLikeRange = 0.05F;
// A single pair says no more than this, so that edges do not count for more than surfaces do.
constexpr float kLargestStep = 0.5F;
// As many pairs are supposed to say that two beams are equal.
constexpr double kPriorPairs = 10.0;
constexpr int kPairColumnStep = 4;
// What is learned of beams is forgotten over as many scans: that they differ lasts, what they look
// at does not.
constexpr double kMemory_scans = 30.0;
// Beams differ in groups, of four as a rule: fewer rows would not show the trend among them.
constexpr int kFewestTrendRows = 4;

// The value at 0 of the line fitted to offsets[r - reach ... r + reach]: what a row would be if its
// beam did not differ. A line, so that the scene's own gradient takes no part at the edges either.
double trend_at(std::span<const double> offsets, int r, int reach) {
  const int last = std::min(static_cast<int>(offsets.size()) - 1, r + reach);
  double n = 0, x_sum = 0, xx_sum = 0, y_sum = 0, xy_sum = 0;
  for (int q = std::max(0, r - reach); q <= last; ++q) {
    const double x = q - r;
    const double y = offsets[static_cast<std::size_t>(q)];
    n += 1;
    x_sum += x;
    xx_sum += x * x;
    y_sum += y;
    xy_sum += x * y;
  }
  const double determinant = n * xx_sum - x_sum * x_sum;
  return determinant > 0 ? (y_sum * xx_sum - xy_sum * x_sum) / determinant : y_sum / n;
}

double median_spacing_deg(std::span<const double> altitude_deg) {
  std::vector<double> spacing_deg;
  for (std::size_t r = 1; r < altitude_deg.size(); ++r) {
    spacing_deg.push_back(std::abs(altitude_deg[r] - altitude_deg[r - 1]));
  }
  if (spacing_deg.empty()) return 1.0;
  const auto middle = spacing_deg.begin() + static_cast<std::ptrdiff_t>(spacing_deg.size() / 2);
  std::nth_element(spacing_deg.begin(), middle, spacing_deg.end());
  return std::max(*middle, 0.01);
}

}  // namespace

ImageFilter::ImageFilter(const SensorInfo& info)
    : half_columns_(std::clamp(
          static_cast<int>(std::lround(kWindowAzimuth_deg / 720.0 * info.columns_per_frame)), 1,
          std::max(1, (info.columns_per_frame - 1) / 2))),
      trend_rows_(std::max(kFewestTrendRows, static_cast<int>(std::lround(
                                                 kWindowElevation_deg /
                                                 median_spacing_deg(info.beam_altitude_deg))))),
      levels_(info.pixels_per_column, info.columns_per_frame),
      valid_(info.pixels_per_column, info.columns_per_frame) {
  const int rows = info.pixels_per_column;
  const auto near = [&](int r, int q) {
    return std::abs(info.beam_altitude_deg[static_cast<std::size_t>(r)] -
                    info.beam_altitude_deg[static_cast<std::size_t>(q)]) <=
           kWindowElevation_deg / 2;
  };
  Rows window{0, 0};
  for (int r = 0; r < rows; ++r) {
    // Neighbours in any case, however far apart; and windows only move on.
    while (window.first < r - 1 && !near(r, window.first)) ++window.first;
    window.last = std::max(window.last, std::min(r + 1, rows - 1));
    while (window.last + 1 < rows && near(r, window.last + 1)) ++window.last;
    window_rows_.push_back(window);
  }
  const auto height = static_cast<std::size_t>(rows);
  steps_.resize(height > 0 ? height - 1 : 0);
  offsets_.resize(height);
  row_factors_.assign(height, 1.0);
  for (ColumnSums* sums : {&columns_, &windows_}) {
    for (auto* sum : {&sums->pixels, &sums->levels, &sums->squares}) {
      sum->resize(static_cast<std::size_t>(info.columns_per_frame));
    }
  }
}

void ImageFilter::apply(const Image<std::uint16_t>& intensity, const Image<std::uint32_t>& range_mm,
                        Image<std::uint8_t>& brightness) {
  compare_beams(intensity, range_mm);
  update_factors();
  scale_rows(intensity, range_mm);
  for (auto* sum : {&columns_.pixels, &columns_.levels, &columns_.squares}) {
    std::fill(sum->begin(), sum->end(), 0.0);
  }
  Rows counted{0, -1};
  for (int row = 0; row < levels_.rows; ++row) {
    const Rows& window = window_rows_[static_cast<std::size_t>(row)];
    while (counted.last < window.last) count_row(++counted.last, 1.0);
    while (counted.first < window.first) count_row(counted.first++, -1.0);
    sum_along_row();
    write_row(row, brightness.row(row));
  }
}

// steps_[r] follows the mean of the pairs' logarithmic ratios, of which each says at most
// kLargestStep more or less than what was believed before (a Huber mean that runs).
void ImageFilter::compare_beams(const Image<std::uint16_t>& intensity,
                                const Image<std::uint32_t>& range_mm) {
  // The first scans are believed at once.
  const double gain = std::max(1.0 / kMemory_scans, 1.0 / (1.0 + scans_ / 4.0));
  ++scans_;
  for (int r = 0; r + 1 < intensity.rows; ++r) {
    double& step = steps_[static_cast<std::size_t>(r)];
    const auto expected = static_cast<float>(std::exp(-step));
    double sum = 0.0;
    int pairs = 0;
    for (int u = 0; u < intensity.cols; u += kPairColumnStep) {
      const auto range = static_cast<float>(range_mm(r, u));
      const auto next_range = static_cast<float>(range_mm(r + 1, u));
      // Without a return on either side this is never so.
      if (std::abs(range - next_range) >= kLikeRange * std::min(range, next_range)) continue;
      const float here = static_cast<float>(intensity(r, u)) + 0.5F;
      const float next = expected * (static_cast<float>(intensity(r + 1, u)) + 0.5F);
      // log(next / here), to second order.
      sum += std::clamp(2.0F * (next - here) / (next + here), -kLargestStep, kLargestStep);
      ++pairs;
    }
    step += gain * sum / (pairs + kPriorPairs);
  }
}

// A beam's own factor is what it differs by from the trend of the rows around it: what the scene
// does to many rows stays.
void ImageFilter::update_factors() {
  for (std::size_t r = 0; r < steps_.size(); ++r) offsets_[r + 1] = offsets_[r] + steps_[r];
  for (std::size_t r = 0; r < offsets_.size(); ++r) {
    const double trend = trend_at(offsets_, static_cast<int>(r), trend_rows_);
    row_factors_[r] = std::exp(trend - offsets_[r]);
  }
}

void ImageFilter::scale_rows(const Image<std::uint16_t>& intensity,
                             const Image<std::uint32_t>& range_mm) {
  const auto cols = static_cast<std::size_t>(intensity.cols);
  for (int r = 0; r < intensity.rows; ++r) {
    const auto factor = static_cast<float>(row_factors_[static_cast<std::size_t>(r)]);
    const auto in = intensity.row(r);
    const auto range = range_mm.row(r);
    const auto level = levels_.row(r);
    const auto valid = valid_.row(r);
    for (std::size_t u = 0; u < cols; ++u) {
      valid[u] = range[u] > 0 ? 1.0F : 0.0F;
      const float scaled = kLevelsPerUnit * factor * static_cast<float>(in[u]) + 0.5F;
      level[u] = valid[u] * static_cast<float>(static_cast<std::int32_t>(scaled));
    }
  }
}

void ImageFilter::count_row(int row, double sign) {
  const auto level = levels_.row(row);
  const auto valid = valid_.row(row);
  for (std::size_t u = 0; u < level.size(); ++u) {
    const double value = level[u];
    columns_.pixels[u] += sign * valid[u];
    columns_.levels[u] += sign * value;
    columns_.squares[u] += sign * value * value;
  }
}

// windows_ of every column from columns_, round the seam.
void ImageFilter::sum_along_row() {
  const int cols = levels_.cols;
  double pixels = 0.0;
  double levels = 0.0;
  double squares = 0.0;
  const auto add = [&](int u, double sign) {
    const auto column = static_cast<std::size_t>(u < 0 ? u + cols : u < cols ? u : u - cols);
    pixels += sign * columns_.pixels[column];
    levels += sign * columns_.levels[column];
    squares += sign * columns_.squares[column];
  };
  for (int u = -half_columns_; u < half_columns_; ++u) add(u, 1.0);
  for (int u = 0; u < cols; ++u) {
    add(u + half_columns_, 1.0);
    windows_.pixels[static_cast<std::size_t>(u)] = pixels;
    windows_.levels[static_cast<std::size_t>(u)] = levels;
    windows_.squares[static_cast<std::size_t>(u)] = squares;
    add(u - half_columns_, -1.0);
  }
}

void ImageFilter::write_row(int row, std::span<std::uint8_t> out) const {
  const auto level = levels_.row(row);
  const auto valid = valid_.row(row);
  constexpr float kNoise = kNoiseDeviations * kNoiseDeviations * kLevelsPerUnit;
  for (std::size_t u = 0; u < out.size(); ++u) {
    const double n = std::max(windows_.pixels[u], 1.0);
    const double mean = windows_.levels[u] / n;
    // Of exact sums, so the difference is good even where it is small.
    const double variance = windows_.squares[u] / n - mean * mean;
    const auto m = static_cast<float>(mean);
    const float noise = kNoise * (m + kLevelsPerUnit);
    const float contrast =
        kContrast * (level[u] - m) / std::sqrt(static_cast<float>(variance) + noise);
    const float grey = std::clamp(kMiddle + valid[u] * contrast + 0.5F, 1.0F, 255.0F);
    out[u] = static_cast<std::uint8_t>(static_cast<std::int32_t>(grey));
  }
}

}  // namespace glint::slam
