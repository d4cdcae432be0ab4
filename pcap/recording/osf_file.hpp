// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

/// Whether a file's first bytes are those of an OSF file ("Open Sensor Format").
bool is_osf(ByteSpan start);

/// The metadata JSON of the first sensor in an OSF file; null if the file was never finished, or
/// names no sensor. OSF keeps decoded scans as compressed images and no packets, so metadata is all
/// that can be had from it here. @throws InputError if the file cannot be read.
std::optional<std::string> find_osf_metadata(const std::filesystem::path& file);

}  // namespace glint::recording
