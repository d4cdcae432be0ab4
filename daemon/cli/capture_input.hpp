// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "driver/core/sensor_info.hpp"
#include "pcap/pcap_source.hpp"

namespace glint::cli {

/// What commands that read a capture ask for: CAPTURE [--meta META] [--source-ip ADDRESS].
struct CaptureInput {
  std::string capture;
  std::string meta;       ///< Empty: STEM.json, else metadata.json, beside the capture.
  std::string source_ip;  ///< Empty: any.
};

/// Adds the arguments to a sub-command; `input` must outlive the parsing.
void add_capture_options(CLI::App& command, CaptureInput& input);

/// The metadata file named, or found beside the capture; null if there is none.
/// @throws InputError if the capture does not exist.
std::optional<std::filesystem::path> find_metadata(const CaptureInput& input);

/// Reads the metadata. @throws InputError, also when there is none, saying where it was looked for.
SensorInfo load_capture_info(const CaptureInput& input);

/// The address to filter by. @throws UsageError if it is none.
std::optional<IpAddress> source_address(const CaptureInput& input);

/// Prints sentences on what was not as expected, each on a line of standard error.
void print_notices(const std::vector<std::string>& notices);

}  // namespace glint::cli
