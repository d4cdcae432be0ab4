// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

#include "daemon/protocol.hpp"
#include "daemon/scan_tap.hpp"

namespace glint::daemon {

/// The `kind` of a get_image. @throws RpcError.
std::string image_kind(const Json& params);

/// One destaggered image of a scan as PNG, in base64, with its size and the scan's time.
/// @throws RpcError(kNotConfigured) when the sensor's profile lacks it.
Json image_json(const TappedScan& tapped, const std::string& kind);

}  // namespace glint::daemon
