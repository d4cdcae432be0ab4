// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "driver/core/metadata_check.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"
#include "pcap/capture_reader.hpp"

namespace glint {

/// Datagrams of one kind in a capture.
struct Flow {
  IpAddress source;
  std::uint16_t port = 0;    ///< Destination.
  std::size_t bytes = 0;     ///< Payload of each.
  std::uint64_t serial = 0;  ///< The sensor's, by the packet header; 0 where it cannot be told.
  std::uint64_t datagrams = 0;
  PacketEvidence evidence;  ///< Of packets of the size that was looked for.
};

/// What UDP there is in a capture.
struct FlowSurvey {
  std::vector<Flow> flows;         ///< Most datagrams first; at most 1024.
  std::uint64_t datagrams = 0;     ///< Of all flows, listed or not.
  HostTime first_time, last_time;  ///< Of the datagrams.
  CaptureCounters counters;
  std::string link_type;
  std::string problem;  ///< As CaptureReader::problem().
};

/// Reads a capture to see what flows there are. With a `format`, sensors are told apart by serial
/// number, and reading stops some thousand datagrams after the first packet of the format's size.
/// @throws InputError as CaptureReader does.
FlowSurvey survey_flows(const std::filesystem::path& file, const PacketFormat* format = nullptr);

/// Which datagrams of a capture are one sensor's.
struct SensorFlow {
  IpAddress source;
  std::uint16_t lidar_port = 0;
  std::uint16_t imu_port = 0;
  std::uint64_t serial = 0;          ///< To be found in packet headers; 0: do not look.
  std::vector<std::string> notices;  ///< What was not as metadata says, a sentence each.
};

/// Finds the sensor's flow: packets of its size (and serial number where they carry one), on the
/// port that metadata names if there are any, else wherever they are, which a notice then says.
/// @throws InputError if there is none, the sentence says what was seen instead; MetadataError if
/// the packets contradict the metadata.
SensorFlow find_sensor_flow(const FlowSurvey& survey, const std::filesystem::path& file,
                            const SensorInfo& info, const PacketFormat& format,
                            const std::optional<IpAddress>& source_ip);

/// Serial number that packet headers must carry; 0 if the profile's have none or metadata does not
/// say.
std::uint64_t expected_serial(const SensorInfo& info, const PacketFormat& format);

}  // namespace glint
