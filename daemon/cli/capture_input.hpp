// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "driver/core/sensor_info.hpp"
#include "pcap/pcap_source.hpp"

namespace glint::cli {

/// What commands that read a capture ask for: CAPTURE [--meta META] [--source-ip ADDRESS]
/// [--topic PREFIX].
struct CaptureInput {
  std::string capture;
  std::string meta;       ///< Empty: STEM.json, else metadata.json, beside the capture.
  std::string source_ip;  ///< Of a capture: only this sender's. Empty: any.
  std::string topic;      ///< Of a recording: only topics that begin so. Empty: any.
};

/// Adds the arguments to a sub-command; `input` must outlive the parsing.
void add_capture_options(CLI::App& command, CaptureInput& input);

/// Whether there is metadata: named, beside the capture, or inside a recording.
/// @throws InputError if the capture does not exist.
bool has_capture_info(const CaptureInput& input);

/// Reads the metadata. @throws InputError, also when there is none, saying where it was looked for.
SensorInfo load_capture_info(const CaptureInput& input);

/// The text that load_capture_info() reads. @throws InputError, also when there is none.
std::string load_capture_metadata(const CaptureInput& input);

/// Opens the capture or recording, whichever it is by its content.
/// @throws InputError, UsageError if --source-ip is no address.
std::unique_ptr<PacketSource> open_capture(const CaptureInput& input, const SensorInfo& info,
                                           const Pacer& pacer = {});

/// Prints sentences on what was not as expected, each on a line of standard error.
void print_notices(const std::vector<std::string>& notices);

}  // namespace glint::cli
