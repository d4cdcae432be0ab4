// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/sensor_json.hpp"

#include <cmath>
#include <stdexcept>

namespace glint {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 16;
constexpr double kLargestExact = 9007199254740992.0;  // 2^53

}  // namespace

std::optional<json> parse_sensor_json(std::string_view text) {
  if (text.size() > kMaxReplyBytes) return std::nullopt;
  const auto within_depth = [](int depth, json::parse_event_t event, const json&) {
    const bool opens =
        event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && depth >= kMaxDepth) throw std::length_error("nested too deep");
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), within_depth);
  } catch (const json::exception&) {
    return std::nullopt;
  } catch (const std::length_error&) {
    return std::nullopt;
  }
}

const json& member(const json& object, const char* key) {
  static const json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

std::string text_member(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<double> number_member(const json& object, const char* key) {
  const json& value = member(object, key);
  if (!value.is_number()) return std::nullopt;
  return value.get<double>();
}

std::optional<std::int64_t> integer_member(const json& object, const char* key) {
  const auto value = number_member(object, key);
  if (!value || std::abs(*value) > kLargestExact || *value != std::floor(*value)) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(*value);
}

std::string excerpt(std::string_view text, std::size_t limit) {
  std::string result;
  for (const char c : text) {
    if (result.size() == limit) return result + "...";
    result += c >= ' ' && c <= '~' ? c : ' ';
  }
  return result;
}

}  // namespace glint
