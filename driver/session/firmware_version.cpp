// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/firmware_version.hpp"

#include <fmt/format.h>

#include <charconv>

namespace glint {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::optional<FirmwareVersion> parse_firmware_version(std::string_view text) {
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    if (!is_digit(*at)) {
      ++at;
      continue;
    }
    FirmwareVersion version;
    const auto major = std::from_chars(at, end, version.major_number);
    at = major.ptr;
    if (major.ec != std::errc() || end - at < 2 || *at != '.' || !is_digit(at[1])) continue;
    const auto minor = std::from_chars(at + 1, end, version.minor_number);
    if (minor.ec == std::errc()) return version;
    at = minor.ptr;
  }
  return std::nullopt;
}

std::string to_string(FirmwareVersion version) {
  return fmt::format("{}.{}", version.major_number, version.minor_number);
}

}  // namespace glint
