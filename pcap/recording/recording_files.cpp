// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/recording_files.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <tuple>

#include "pcap/recording/recording_format.hpp"

namespace glint::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 4096;
constexpr int kMaxLines = 1 << 20;

/// Of files numbered without leading zeros, the shorter number comes first.
bool by_part(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& file) {
    const std::string name = file.filename().string();
    const std::string stem = name.substr(0, name.find('.'));
    const std::size_t digits_at = stem.find_last_not_of("0123456789") + 1;
    return std::tuple(stem.substr(0, digits_at), stem.size(), name);
  };
  return key(a) < key(b);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kAround = " \t\r\"'";
  const std::size_t first = text.find_first_not_of(kAround);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kAround) - first + 1);
}

/// The items of "relative_file_paths", which recorders write one a line. The rest of the file says
/// nothing that the recording itself does not.
std::vector<fs::path> listed_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::ifstream yaml(folder / "metadata.yaml");
  std::string line;
  bool listing = false;
  for (int count = 0; count < kMaxLines && std::getline(yaml, line); ++count) {
    const std::string_view content = trimmed(line);
    if (content == "relative_file_paths:") {
      listing = true;
    } else if (listing && content.starts_with("- ") && files.size() < kMaxFiles) {
      // Some recorders put the folder's own name in front.
      files.push_back(folder / fs::path(trimmed(content.substr(2))).filename());
    } else if (listing) {
      break;
    }
  }
  return files;
}

}  // namespace

std::vector<fs::path> recording_files(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<fs::path> files = listed_files(path);
  const bool complete =
      std::ranges::all_of(files, [&](const fs::path& file) { return fs::exists(file, error); });
  if (!files.empty() && complete) return files;
  files.clear();
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    if (recording_format(entry.path()) != RecordingFormat::kNone) files.push_back(entry.path());
    if (files.size() >= kMaxFiles) break;
  }
  std::ranges::sort(files, by_part);
  return files;
}

bool is_recording(const fs::path& path) {
  return std::ranges::any_of(recording_files(path), [](const fs::path& file) {
    return recording_format(file) != RecordingFormat::kNone;
  });
}

}  // namespace glint::recording
