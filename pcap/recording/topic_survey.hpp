// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "driver/core/metadata_check.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/time.hpp"
#include "pcap/recording/recording_metadata.hpp"

namespace glint::recording {

/// Messages of one kind in a recording.
struct TopicFlow {
  std::string topic;
  std::string type;
  std::size_t bytes = 0;     ///< Of the packet in each; 0 if the type carries none.
  std::uint64_t serial = 0;  ///< The sensor's, by the packet header; 0 where it cannot be told.
  std::uint64_t messages = 0;
  PacketEvidence evidence;  ///< Of packets of the size that was looked for.
};

/// What there is in a recording.
struct TopicSurvey {
  std::vector<TopicFlow> flows;            ///< Most messages first; at most 1024.
  std::vector<RecordedMetadata> metadata;  ///< In order of recording, one a topic; at most 64.
  std::uint64_t messages = 0;              ///< Of all flows, listed or not.
  HostTime first_time, last_time;          ///< Of the messages.
  std::string problem;                     ///< As MessageReader::problem().
};

/// Reads a recording to see what there is. With a `format`, sensors are told apart by serial
/// number, and reading stops some thousand packets after the first one of the format's size.
/// @throws InputError as open_messages() does.
TopicSurvey survey_topics(const std::filesystem::path& file, const PacketFormat* format = nullptr);

/// Which messages of a recording are one sensor's.
struct SensorTopics {
  std::string lidar;
  std::string imu;                   ///< Empty if there is none.
  std::uint64_t serial = 0;          ///< To be found in packet headers; 0: do not look.
  std::vector<std::string> notices;  ///< What was not as expected, a sentence each.
};

/// Finds the sensor's topics: that with packets of its size (and serial number where they carry
/// one), and that of IMU packets in the same namespace.
/// @param prefix Only topics that begin with it; empty: all.
/// @throws InputError if there is none, the sentence says what was seen instead; MetadataError if
/// the packets contradict the metadata.
SensorTopics find_sensor_topics(const TopicSurvey& survey, const std::filesystem::path& file,
                                const SensorInfo& info, const PacketFormat& format,
                                std::string_view prefix);

/// Whether a packet has the size, or is one byte longer, as early ROS drivers recorded them.
constexpr bool has_size(std::size_t packet_bytes, std::size_t expected) {
  return packet_bytes == expected || packet_bytes == expected + 1;
}

}  // namespace glint::recording
