// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

/// A sensor's firmware, which decides what its interface looks like. Value type.
struct FirmwareVersion {
  int major_number = 0;
  int minor_number = 0;

  friend constexpr auto operator<=>(const FirmwareVersion&, const FirmwareVersion&) = default;
};

/// The first "N.N" in a text: "v2.3.1-rc.1", "ousteros-image-prod-aries-v1.12.0-20190502211317".
/// Null when there is none.
std::optional<FirmwareVersion> parse_firmware_version(std::string_view text);

/// "2.3".
std::string to_string(FirmwareVersion version);

}  // namespace glint
