// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <string_view>

namespace glint::cli {

/// Writes a whole file under a temporary name and renames it, so that no half file is ever seen
/// under its own. @throws InputError naming the file and the cause.
void write_text_file(const std::filesystem::path& file, std::string_view content);

}  // namespace glint::cli
