// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

namespace glint::slam {

/// Waits until what a file holds is on the disk. @throws InputError naming it.
void sync_file(const std::filesystem::path& file);

/// Waits until the name of a file is in its directory on the disk. @throws InputError naming it.
void sync_directory_of(const std::filesystem::path& file);

}  // namespace glint::slam
