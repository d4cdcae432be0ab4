// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_image.hpp"

#include <fmt/format.h>

#include "daemon/base64.hpp"
#include "daemon/png.hpp"
#include "driver/core/destagger.hpp"

namespace glint::daemon {
namespace {

template <class T>
Image<std::uint8_t> destaggered_preview(const Image<T>& staggered, const SensorInfo& info) {
  if (staggered.empty()) return {};
  Image<T> image(staggered.rows, staggered.cols);
  destagger(staggered, info.pixel_shift_by_row, image);
  return grey_preview(image);
}

Image<std::uint8_t> picture(const TappedScan& tapped, const std::string& kind) {
  const LidarScan& scan = tapped.scan;
  if (kind == "range") return destaggered_preview(scan.range_mm, *tapped.info);
  if (kind == "signal") return destaggered_preview(scan.signal, *tapped.info);
  if (kind == "reflectivity") return destaggered_preview(scan.reflectivity, *tapped.info);
  if (kind == "near_ir") return destaggered_preview(scan.near_ir, *tapped.info);
  return tapped.filtered;
}

}  // namespace

std::string image_kind(const Json& params) {
  return choice_param(params, "kind", "range|signal|reflectivity|near_ir|filtered");
}

Json image_json(const TappedScan& tapped, const std::string& kind) {
  const Image<std::uint8_t> grey = picture(tapped, kind);
  if (grey.empty()) {
    throw RpcError(kNotConfigured,
                   fmt::format("the sensor's packets have no {}; sensor.udp_profile_lidar names "
                               "what they hold",
                               kind),
                   "sensor.udp_profile_lidar");
  }
  Json out{{"kind", kind}, {"frame_id", tapped.scan.frame_id}};
  put_time(out, tapped.stamp);
  out["rows"] = grey.rows;
  out["cols"] = grey.cols;
  out["png"] = base64_encode(encode_png(grey));
  return out;
}

const Json& ImageCache::json(const std::shared_ptr<const TappedScan>& tapped,
                             const std::string& kind) {
  if (tapped_ != tapped) made_.clear();
  tapped_ = tapped;
  const auto made = made_.find(kind);
  if (made != made_.end()) return made->second;
  return made_.emplace(kind, image_json(*tapped, kind)).first->second;
}

}  // namespace glint::daemon
