// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <memory>

#include "pcap/recording/message.hpp"
#include "pcap/recording/recording_format.hpp"

namespace glint::recording {

/// Opens a recording by its content, whatever its name: a file of any format, packed with zstd or
/// not, or a folder of several, which are read one after the other.
/// @throws InputError if it cannot be read, is no recording, or one that holds no messages (OSF).
std::unique_ptr<MessageReader> open_messages(const std::filesystem::path& path);

}  // namespace glint::recording
