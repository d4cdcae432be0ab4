// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/scan_images.hpp"

#include <algorithm>
#include <cmath>

#include "driver/core/destagger.hpp"
#include "slam/image_filter.hpp"

namespace glint::slam {
namespace {

constexpr double kLowQuantile = 0.01;
constexpr double kHighQuantile = 0.99;
// How fast the quantiles follow the scene, per scan: slow enough that a passing reflector does not
// make the whole image flicker and with it every descriptor.
constexpr double kQuantileGain = 0.1;

// The value below which `share` of the histogram's `total` entries lie.
double quantile(const std::vector<std::uint32_t>& histogram, std::uint64_t total, double share) {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(total));
  std::uint64_t seen = 0;
  for (std::size_t value = 0; value < histogram.size(); ++value) {
    seen += histogram[value];
    if (seen > wanted) return static_cast<double>(value);
  }
  return static_cast<double>(histogram.size() - 1);
}

}  // namespace

ImageFormer::ImageFormer(const SensorInfo& info, const SlamConfig& config)
    : shift_(info.pixel_shift_by_row),
      min_range_mm_(static_cast<std::uint32_t>(std::lround(config.min_range_m * 1000.0))),
      histogram_(65536),
      scaled_(65536),
      filter_(config.image_filter ? std::make_unique<ImageFilter>(info) : nullptr) {}

ImageFormer::~ImageFormer() = default;

void ImageFormer::form(const LidarScan& scan, ScanImages& images) {
  const Image<std::uint16_t>& channel = scan.signal.empty() ? scan.reflectivity : scan.signal;
  for (auto* image : {&images.intensity, &images.near_ir}) {
    const auto& source = image == &images.near_ir ? scan.near_ir : channel;
    if (image->rows != source.rows || image->cols != source.cols) {
      *image = Image<std::uint16_t>(source.rows, source.cols);
    }
    if (!source.empty()) destagger<std::uint16_t>(source, shift_, *image);
  }
  if (images.range_mm.rows != scan.range_mm.rows || images.range_mm.cols != scan.range_mm.cols) {
    images.range_mm = Image<std::uint32_t>(scan.range_mm.rows, scan.range_mm.cols);
    images.intensity_u8 = Image<std::uint8_t>(scan.range_mm.rows, scan.range_mm.cols);
    images.brightness = images.intensity_u8;
  }
  destagger<std::uint32_t>(scan.range_mm, shift_, images.range_mm);
  for (auto& range_mm : images.range_mm.data) {
    if (range_mm < min_range_mm_) range_mm = 0;
  }
  update_scale(images);
  for (std::size_t i = 0; i < images.intensity_u8.data.size(); ++i) {
    images.intensity_u8.data[i] =
        images.range_mm.data[i] > 0 ? scaled_[images.intensity.data[i]] : 0;
  }
  if (filter_ != nullptr) {
    filter_->apply(images.intensity, images.range_mm, images.brightness);
  } else {
    images.brightness.data = images.intensity_u8.data;
  }
}

void ImageFormer::update_scale(const ScanImages& images) {
  std::fill(histogram_.begin(), histogram_.end(), 0U);
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < images.intensity.data.size(); i += 3) {
    if (images.range_mm.data[i] == 0) continue;
    ++histogram_[images.intensity.data[i]];
    ++total;
  }
  if (total > 0) {
    const double low = quantile(histogram_, total, kLowQuantile);
    const double high = quantile(histogram_, total, kHighQuantile);
    low_ = high_ < 0 ? low : low_ + kQuantileGain * (low - low_);
    high_ = high_ < 0 ? high : high_ + kQuantileGain * (high - high_);
  }
  // 0 is kept for "no return".
  const double gain = 254.0 / std::max(1.0, high_ - low_);
  for (std::size_t value = 0; value < scaled_.size(); ++value) {
    const double scaled = 1.0 + (static_cast<double>(value) - low_) * gain;
    scaled_[value] = static_cast<std::uint8_t>(std::clamp(scaled, 1.0, 255.0));
  }
}

}  // namespace glint::slam
