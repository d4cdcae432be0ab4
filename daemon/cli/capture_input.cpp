// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/capture_input.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <iterator>

#include "daemon/cli/command.hpp"
#include "driver/core/error.hpp"
#include "pcap/recording/recording_files.hpp"
#include "pcap/recording/recording_metadata.hpp"
#include "pcap/recording/recording_source.hpp"

namespace glint::cli {

namespace fs = std::filesystem;

void add_capture_options(CLI::App& command, CaptureInput& input) {
  command
      .add_option("CAPTURE", input.capture,
                  "Capture (pcap, pcapng) or recording (ROS 1 bag, ROS 2 bag, MCAP)")
      ->required();
  command.add_option(
      "--meta", input.meta,
      "Sensor metadata (JSON); default: STEM.json, else metadata.json, beside it, else the "
      "recording's own");
  command.add_option("--source-ip", input.source_ip,
                     "Of a capture: only packets that this address sent");
  command.add_option("--topic", input.topic, "Of a recording: only topics that begin with this");
}

namespace {

// The file named, or found beside the capture.
std::optional<fs::path> find_metadata_file(const CaptureInput& input) {
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

std::optional<std::string> metadata_inside(const CaptureInput& input) {
  if (!recording::is_recording(input.capture)) return std::nullopt;
  return recording::find_metadata(input.capture, input.topic);
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

}  // namespace

bool has_capture_info(const CaptureInput& input) {
  return find_metadata_file(input) || metadata_inside(input);
}

namespace {

[[noreturn]] void fail_without_metadata(const CaptureInput& input) {
  fs::path beside = input.capture;
  beside.replace_extension(".json");
  throw InputError(
      fmt::format("There is no metadata for {}: neither {} nor metadata.json beside it; name the "
                  "sensor's metadata file with --meta.",
                  input.capture, beside.string()));
}

}  // namespace

SensorInfo load_capture_info(const CaptureInput& input) {
  SensorInfo info;
  if (const auto file = find_metadata_file(input)) {
    info = load_sensor_info(*file);
  } else if (const auto json = metadata_inside(input)) {
    info = parse_sensor_info(*json, input.capture);
  } else {
    fail_without_metadata(input);
  }
  print_notices(info.warnings);
  return info;
}

std::string load_capture_metadata(const CaptureInput& input) {
  if (const auto file = find_metadata_file(input)) {
    static_cast<void>(load_sensor_info(*file));  // Tells what is wrong with it.
    std::ifstream in(*file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  if (auto json = metadata_inside(input)) return *std::move(json);
  fail_without_metadata(input);
}

std::unique_ptr<PacketSource> open_capture(const CaptureInput& input, const SensorInfo& info,
                                           const Pacer& pacer) {
  if (recording::is_recording(input.capture)) {
    return std::make_unique<recording::RecordingSource>(
        input.capture, info, recording::RecordingSourceOptions{input.topic, pacer});
  }
  return std::make_unique<PcapSource>(input.capture, info,
                                      PcapSourceOptions{source_address(input), pacer});
}

void print_notices(const std::vector<std::string>& notices) {
  for (const std::string& notice : notices) std::cerr << "glint: " << notice << '\n';
}

}  // namespace glint::cli
