// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/saved_maps.hpp"

#include <fmt/format.h>

#include <system_error>

#include "daemon/session_files.hpp"
#include "driver/core/error.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

InputError unusable(const fs::path& directory, const std::error_code& error) {
  return InputError(
      fmt::format("the folder of maps {} cannot be used: {}; change its permissions "
                  "or state.directory",
                  directory.string(), error.message()));
}

}  // namespace

SavedMaps::SavedMaps(const fs::path& state_directory)
    : directory_(state_directory.empty() ? fs::path() : state_directory / "maps") {}

fs::path SavedMaps::file_of(std::string_view name) const {
  if (!is_name(name)) throw InputError(fmt::format("a map's name is {}", kNameRule));
  return directory_ / fmt::format("{}{}", name, kSessionSuffix);
}

void SavedMaps::make_place() const {
  std::error_code error;
  fs::create_directories(directory_, error);
  if (error) throw unusable(directory_, error);
}

std::vector<std::string> SavedMaps::names() const {
  std::error_code error;
  if (!fs::exists(directory_, error)) return {};
  std::vector<std::string> names;
  for (const fs::path& file : session_files(directory_)) {
    std::string name = file.stem().string();
    if (is_name(name)) names.push_back(std::move(name));
  }
  return names;
}

bool SavedMaps::contains(std::string_view name) const {
  std::error_code error;
  return fs::is_regular_file(file_of(name), error);
}

bool SavedMaps::remove(std::string_view name) const {
  if (!contains(name)) return false;
  std::error_code error;
  remove_session(file_of(name), error);
  if (error) throw unusable(directory_, error);
  return true;
}

}  // namespace glint::daemon
