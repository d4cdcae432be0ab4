// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <map>
#include <memory>
#include <string>

#include "daemon/protocol.hpp"
#include "daemon/scan_tap.hpp"

namespace glint::daemon {

/// The `kind` of a get_image. @throws RpcError.
std::string image_kind(const Json& params);

/// One destaggered image of a scan as PNG, in base64, with its size and the scan's time.
/// @throws RpcError(kNotConfigured) when the sensor's profile lacks it.
Json image_json(const TappedScan& tapped, const std::string& kind);

/// The images of the latest scan that somebody looked at, each made once for all who do. Of one
/// thread.
class ImageCache {
 public:
  /// As image_json(). `tapped` is not null.
  const Json& json(const std::shared_ptr<const TappedScan>& tapped, const std::string& kind);

 private:
  std::shared_ptr<const TappedScan> tapped_;
  std::map<std::string, Json> made_;  ///< Of it, by kind.
};

}  // namespace glint::daemon
