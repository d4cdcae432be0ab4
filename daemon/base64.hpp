// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::daemon {

/// RFC 4648, with padding.
std::string base64_encode(std::span<const std::byte> bytes);
/// Null for anything that base64_encode does not give.
std::optional<std::vector<std::byte>> base64_decode(std::string_view text);

}  // namespace glint::daemon
