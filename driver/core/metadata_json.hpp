// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

/// Most that is read of metadata; real ones have some 10 kB.
constexpr std::size_t kMaxMetadataBytes = 1U << 20U;

/// Parses untrusted metadata JSON: at most 1 MiB, at most 16 levels deep, no key twice in an
/// object.
/// @throws MetadataError that begins with "metadata NAME".
nlohmann::json parse_metadata_json(std::string_view json, std::string_view name);

/// Reads typed values out of one JSON object of the metadata, with messages that name the key.
/// Non-owning: valid while the object is. An absent group reads as an empty object.
class MetadataGroup {
 public:
  MetadataGroup(const nlohmann::json* object, std::string_view metadata_name,
                std::string_view group_name)
      : object_(object), metadata_name_(metadata_name), group_name_(group_name) {}

  [[nodiscard]] bool absent() const { return object_ == nullptr; }
  [[nodiscard]] bool has(const char* key) const { return find(key) != nullptr; }
  /// The member object of this name; absent unless it is an object (old firmware puts an error
  /// sentence there).
  [[nodiscard]] MetadataGroup group(std::string_view name) const;

  // Each gives null when the key is absent and throws MetadataError when its value is of another
  // type or out of the given range.
  [[nodiscard]] std::optional<std::string> text(const char* key) const;
  [[nodiscard]] std::optional<int> integer(const char* key, int least, int largest) const;
  [[nodiscard]] std::optional<double> number(const char* key, double least, double largest) const;
  [[nodiscard]] std::optional<std::vector<double>> numbers(const char* key, double least,
                                                           double largest) const;
  [[nodiscard]] std::optional<std::vector<int>> integers(const char* key, int least,
                                                         int largest) const;

  /// Throws MetadataError: "metadata NAME: KEY WHAT".
  [[noreturn]] void fail(std::string_view key, std::string_view what) const;

 private:
  [[nodiscard]] const nlohmann::json* find(const char* key) const;

  const nlohmann::json* object_;
  std::string metadata_name_;
  std::string group_name_;
};

}  // namespace glint
