// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

/// Most bytes taken of one answer of a sensor; real metadata has some 10 kB.
constexpr std::size_t kMaxReplyBytes = 1U << 20U;

/// Parses an answer of a sensor, of which nothing is trusted: at most kMaxReplyBytes and 16 levels.
/// Null when it is not JSON within those bounds.
std::optional<nlohmann::json> parse_sensor_json(std::string_view text);

// Members of an object that may be missing, of another type, or in something that is no object:
// then the value is null or empty.
std::string text_member(const nlohmann::json& object, const char* key);
std::optional<double> number_member(const nlohmann::json& object, const char* key);
/// Null also beyond 2^53, where JSON readers disagree.
std::optional<std::int64_t> integer_member(const nlohmann::json& object, const char* key);
/// The member, or null as JSON.
const nlohmann::json& member(const nlohmann::json& object, const char* key);

/// What a stranger wrote, made fit for a message of ours: printable ASCII, at most `limit` bytes.
std::string excerpt(std::string_view text, std::size_t limit = 160);

}  // namespace glint
