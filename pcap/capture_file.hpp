// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdio>
#include <filesystem>

namespace glint {

/// Opens a file for libpcap such that a classic pcap header announces the largest snap length.
/// libpcap cuts records that are longer than the announced one, but captures exist whose records
/// hold whole reassembled datagrams under a header of, say, 1500 bytes.
/// Returns null and sets errno when the file cannot be opened. Not seekable.
std::FILE* open_capture_file(const std::filesystem::path& file);

}  // namespace glint
