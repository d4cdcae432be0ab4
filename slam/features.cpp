// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/features.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "driver/core/destagger.hpp"

namespace glint::slam {
namespace {

// The side of ORB's descriptor patch; an image lower than about two of them gives no pyramid.
constexpr int kPatch_px = 31;
constexpr int kFewestRows = 64;
// The published code lets keypoints come up to the border, where patches see mirrored pixels.
constexpr int kEdge_px = 1;

}  // namespace

struct FeatureExtractor::Impl {
  Impl(const SensorInfo& info, const SlamConfig& config, std::shared_ptr<const XyzLut> table)
      : lut(std::move(table)),
        shift(info.pixel_shift_by_row),
        row_factor((kFewestRows + info.pixels_per_column - 1) / info.pixels_per_column),
        upright(config.orb_upright),
        orb(cv::ORB::create(config.orb_features, static_cast<float>(config.orb_scale),
                            config.orb_levels, kEdge_px, 0, 2, cv::ORB::HARRIS_SCORE, kPatch_px,
                            config.orb_fast_threshold)) {
    cv::setNumThreads(1);
  }

  const std::shared_ptr<const XyzLut> lut;
  const std::vector<int> shift;
  const int row_factor;  // By how much rows are enlarged; 1 from 64 beams on.
  const bool upright;
  const cv::Ptr<cv::ORB> orb;
  cv::Mat enlarged;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

void Features::clear() {
  keypoints.clear();
  descriptors.clear();
  raw_points_m.clear();
  columns.clear();
  points_m.clear();
}

void Features::deskew(std::span<const Pose> T_reference_column) {
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    points_m[i] = T_reference_column[static_cast<std::size_t>(columns[i])] * raw_points_m[i];
  }
}

FeatureExtractor::FeatureExtractor(const SensorInfo& info, const SlamConfig& config,
                                   std::shared_ptr<const XyzLut> lut)
    : impl_(std::make_unique<Impl>(info, config, std::move(lut))) {}

FeatureExtractor::~FeatureExtractor() = default;

void FeatureExtractor::set_most(int keypoints) { impl_->orb->setMaxFeatures(keypoints); }

void FeatureExtractor::extract(const ScanImages& images, Features& features) {
  Impl& my = *impl_;
  const int rows = images.brightness.rows;
  const int cols = images.brightness.cols;
  // OpenCV has no view of constant data; the image is only read.
  cv::Mat image(rows, cols, CV_8UC1, const_cast<std::uint8_t*>(images.brightness.data.data()));
  if (my.row_factor > 1) {
    cv::resize(image, my.enlarged, {cols, rows * my.row_factor}, 0, 0, cv::INTER_LINEAR);
    image = my.enlarged;
  }
  if (my.upright) {
    my.orb->detect(image, my.keypoints);
    for (cv::KeyPoint& keypoint : my.keypoints) keypoint.angle = 0.0F;
    my.orb->compute(image, my.keypoints, my.descriptors);
  } else {
    // At one go the pyramid is made once.
    my.orb->detectAndCompute(image, cv::noArray(), my.keypoints, my.descriptors);
  }

  features.clear();
  for (std::size_t i = 0; i < my.keypoints.size(); ++i) {
    const cv::KeyPoint& keypoint = my.keypoints[i];
    const auto factor = static_cast<float>(my.row_factor);
    // Centre of an enlarged row to that of the original one.
    const float v_px = (keypoint.pt.y + 0.5F) / factor - 0.5F;
    const int row = std::clamp(static_cast<int>(std::lround(v_px)), 0, rows - 1);
    const int col = std::clamp(static_cast<int>(std::lround(keypoint.pt.x)), 0, cols - 1);
    const std::uint32_t range_mm = images.range_mm(row, col);
    if (range_mm == 0) continue;
    const int m = staggered_column(col, my.shift[static_cast<std::size_t>(row)], cols);
    const auto degrees_to_rad = static_cast<float>(M_PI / 180.0);
    features.keypoints.push_back(
        {keypoint.pt.x, v_px, keypoint.angle * degrees_to_rad, keypoint.octave, keypoint.response});
    Descriptor descriptor;
    std::memcpy(descriptor.data(), my.descriptors.ptr(static_cast<int>(i)), sizeof descriptor);
    features.descriptors.push_back(descriptor);
    features.raw_points_m.push_back(my.lut->point(row, m, range_mm));
    features.columns.push_back(m);
  }
  features.points_m = features.raw_points_m;
}

}  // namespace glint::slam
