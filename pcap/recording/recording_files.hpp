// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <vector>

namespace glint::recording {

/// The files of a recording, in order: of a file, itself. Of a folder, those that the metadata.yaml
/// of a ROS 2 bag lists if all are there, else all recordings in it by name, "x_2" before "x_10".
/// Empty if there are none.
std::vector<std::filesystem::path> recording_files(const std::filesystem::path& path);

/// Whether a file or folder is a recording that can be opened here, by its content.
bool is_recording(const std::filesystem::path& path);

}  // namespace glint::recording
