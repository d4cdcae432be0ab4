// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/metadata_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "driver/core/error.hpp"

namespace glint {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxTextBytes = 128;

// What a stranger wrote, made fit for a message.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, kMaxTextBytes));
  for (char& c : result) {
    if (c < ' ' || c > '~') c = '?';
  }
  return result;
}

// Watches the parser for what it would let pass: depth, and keys that come twice.
class ParseGuard {
 public:
  explicit ParseGuard(std::string_view name) : name_(name) {}

  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    switch (event) {
      case json::parse_event_t::object_start:
      case json::parse_event_t::array_start:
        if (depth >= kMaxDepth) {
          throw MetadataError(fmt::format(
              "metadata {}: nested deeper than {} levels, so it is no Ouster metadata; name "
              "the sensor's",
              name_, kMaxDepth));
        }
        if (event == json::parse_event_t::object_start) keys_.emplace_back();
        break;
      case json::parse_event_t::object_end:
        keys_.pop_back();
        break;
      case json::parse_event_t::key:
        if (!keys_.back().insert(parsed.get<std::string>()).second) {
          throw MetadataError(fmt::format(
              "metadata {}: the key {} comes twice, so it is unclear which value holds; keep one",
              name_, shown(parsed.get_ref<const std::string&>())));
        }
        break;
      default:
        break;
    }
    return true;
  }

 private:
  std::string_view name_;
  std::vector<std::set<std::string>> keys_;
};

std::optional<double> as_number(const json& value, double least, double largest) {
  if (!value.is_number()) return std::nullopt;
  const auto number = value.get<double>();
  return number >= least && number <= largest ? std::optional(number) : std::nullopt;
}

std::optional<int> as_integer(const json& value, int least, int largest) {
  const auto number = as_number(value, least, largest);
  if (!number || *number != std::floor(*number)) return std::nullopt;
  return static_cast<int>(*number);
}

}  // namespace

json parse_metadata_json(std::string_view text, std::string_view name) {
  if (text.size() > kMaxMetadataBytes) {
    throw MetadataError(fmt::format(
        "metadata {}: larger than {} bytes, so it is no Ouster metadata; name the sensor's", name,
        kMaxMetadataBytes));
  }
  json root;
  try {
    root = json::parse(
        text.begin(), text.end(),
        [guard = ParseGuard(name)](int depth, json::parse_event_t event, json& parsed) mutable {
          return guard(depth, event, parsed);
        });
  } catch (const json::parse_error& error) {
    throw MetadataError(fmt::format(
        "metadata {}: not JSON from byte {} on; get it from the sensor at /api/v1/sensor/metadata",
        name, error.byte));
  } catch (const json::exception&) {
    throw MetadataError(
        fmt::format("metadata {}: holds a number beyond what JSON readers take; get it from the "
                    "sensor at /api/v1/sensor/metadata",
                    name));
  }
  if (!root.is_object()) {
    throw MetadataError(fmt::format(
        "metadata {}: not a JSON object; get it from the sensor at /api/v1/sensor/metadata", name));
  }
  return root;
}

MetadataGroup MetadataGroup::group(std::string_view name) const {
  const json* member = nullptr;
  if (object_ != nullptr) {
    const auto it = object_->find(name);
    if (it != object_->end() && it->is_object()) member = &*it;
  }
  return {member, metadata_name_, name};
}

const json* MetadataGroup::find(const char* key) const {
  if (object_ == nullptr) return nullptr;
  const auto it = object_->find(key);
  return it == object_->end() || it->is_null() ? nullptr : &*it;
}

void MetadataGroup::fail(std::string_view key, std::string_view what) const {
  const std::string group = group_name_.empty() ? "" : group_name_ + ".";
  throw MetadataError(fmt::format("metadata {}: {}{} {}", metadata_name_, group, key, what));
}

std::optional<std::string> MetadataGroup::text(const char* key) const {
  const json* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) fail(key, "must be a string");
  const auto& text = value->get_ref<const std::string&>();
  if (text.size() > kMaxTextBytes || shown(text) != text) {
    fail(key,
         fmt::format("must be a string of at most {} printable ASCII characters", kMaxTextBytes));
  }
  return text;
}

std::optional<int> MetadataGroup::integer(const char* key, int least, int largest) const {
  const json* value = find(key);
  if (value == nullptr) return std::nullopt;
  const auto number = as_integer(*value, least, largest);
  if (!number) fail(key, fmt::format("must be a whole number from {} to {}", least, largest));
  return number;
}

std::optional<double> MetadataGroup::number(const char* key, double least, double largest) const {
  const json* value = find(key);
  if (value == nullptr) return std::nullopt;
  const auto result = as_number(*value, least, largest);
  if (!result) fail(key, fmt::format("must be a number from {} to {}", least, largest));
  return result;
}

std::optional<std::vector<double>> MetadataGroup::numbers(const char* key, double least,
                                                          double largest) const {
  const json* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_array()) fail(key, "must be a list of numbers");
  std::vector<double> result;
  for (const json& element : *value) {
    const auto number = as_number(element, least, largest);
    if (!number) fail(key, fmt::format("must hold numbers from {} to {} only", least, largest));
    result.push_back(*number);
  }
  return result;
}

std::optional<std::vector<int>> MetadataGroup::integers(const char* key, int least,
                                                        int largest) const {
  const json* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_array()) fail(key, "must be a list of whole numbers");
  std::vector<int> result;
  for (const json& element : *value) {
    const auto number = as_integer(element, least, largest);
    if (!number)
      fail(key, fmt::format("must hold whole numbers from {} to {} only", least, largest));
    result.push_back(*number);
  }
  return result;
}

}  // namespace glint
