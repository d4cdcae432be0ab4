// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint::daemon {

/// Maps that were saved under a name: NAME.glint in the folder `maps` of state.directory. Clients
/// say names, never paths: every path is made here, of a name that is one. Value type; members that
/// touch the disk may wait for it.
class SavedMaps {
 public:
  /// `state_directory`: empty when there is none, then there are no maps.
  explicit SavedMaps(const std::filesystem::path& state_directory);

  /// A letter or digit, then up to 63 of letters, digits, '.', '_' and '-', all of them ASCII.
  [[nodiscard]] static bool is_name(std::string_view name) {
    constexpr std::string_view kFirst =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    const auto is_first = [&](char c) { return kFirst.find(c) != std::string_view::npos; };
    return !name.empty() && name.size() <= kLongestName && is_first(name.front()) &&
           std::ranges::all_of(
               name, [&](char c) { return is_first(c) || c == '.' || c == '_' || c == '-'; });
  }
  /// What is_name() asks for, for a message.
  static constexpr std::string_view kNameRule =
      "1 to 64 of A-Z a-z 0-9 . _ -, the first one a letter or a digit";

  /// Whether there is a place for maps.
  [[nodiscard]] bool has_place() const { return !directory_.empty(); }
  /// Where the map is or would be. @throws InputError when `name` is none.
  [[nodiscard]] std::filesystem::path file_of(std::string_view name) const;
  /// Makes the folder. @throws InputError naming it.
  void make_place() const;
  /// In order. @throws InputError when the folder is there and cannot be listed.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] bool contains(std::string_view name) const;
  /// False when there was none. @throws InputError when it cannot be removed.
  [[nodiscard]] bool remove(std::string_view name) const;

 private:
  static constexpr std::size_t kLongestName = 64;
  std::filesystem::path directory_;
};

}  // namespace glint::daemon
