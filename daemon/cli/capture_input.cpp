// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/capture_input.hpp"

#include <fmt/format.h>

#include <iostream>

#include "daemon/cli/command.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {

namespace fs = std::filesystem;

void add_capture_options(CLI::App& command, CaptureInput& input) {
  command.add_option("CAPTURE", input.capture, "pcap or pcapng file")->required();
  command.add_option("--meta", input.meta,
                     "Sensor metadata (JSON); default: STEM.json, else metadata.json, beside it");
  command.add_option("--source-ip", input.source_ip, "Only packets that this address sent");
}

std::optional<fs::path> find_metadata(const CaptureInput& input) {
  std::error_code ignored;
  const fs::path capture = input.capture;
  if (!fs::exists(capture, ignored)) {
    throw InputError(
        fmt::format("The capture {} does not exist; check the path.", capture.string()));
  }
  if (!input.meta.empty()) return input.meta;
  fs::path beside = capture;
  beside.replace_extension(".json");
  if (fs::exists(beside, ignored)) return beside;
  beside.replace_filename("metadata.json");
  if (fs::exists(beside, ignored)) return beside;
  return std::nullopt;
}

SensorInfo load_capture_info(const CaptureInput& input) {
  const std::optional<fs::path> file = find_metadata(input);
  if (!file) {
    fs::path beside = input.capture;
    beside.replace_extension(".json");
    throw InputError(
        fmt::format("There is no metadata for {}: neither {} nor metadata.json beside it; name the "
                    "sensor's metadata file with --meta.",
                    input.capture, beside.string()));
  }
  SensorInfo info = load_sensor_info(*file);
  print_notices(info.warnings);
  return info;
}

std::optional<IpAddress> source_address(const CaptureInput& input) {
  if (input.source_ip.empty()) return std::nullopt;
  const std::optional<IpAddress> address = IpAddress::parse(input.source_ip);
  if (!address) {
    throw UsageError(
        fmt::format("--source-ip {} is no IPv4 or IPv6 address; `glint info CAPTURE` lists those "
                    "in the capture.",
                    input.source_ip));
  }
  return address;
}

void print_notices(const std::vector<std::string>& notices) {
  for (const std::string& notice : notices) std::cerr << "glint: " << notice << '\n';
}

}  // namespace glint::cli
