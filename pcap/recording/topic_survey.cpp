// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/topic_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "driver/core/error.hpp"
#include "driver/core/packet_view.hpp"
#include "pcap/flow_survey.hpp"
#include "pcap/recording/message_decoder.hpp"
#include "pcap/recording/message_files.hpp"

namespace glint::recording {
namespace {

constexpr std::size_t kMaxFlows = 1024;
constexpr std::size_t kMaxMetadata = 64;
/// Packets read after the sensor's first: some seconds, in which a second sensor shows itself.
constexpr std::uint64_t kSurveyPackets = 4096;

using FlowKey = std::tuple<std::string, std::string, std::size_t, std::uint64_t>;

struct FlowTally {
  std::uint64_t messages = 0;
  PacketEvidence evidence;
};
using FlowTallies = std::map<FlowKey, FlowTally>;

std::vector<TopicFlow> sorted_flows(const FlowTallies& tallies) {
  std::vector<TopicFlow> flows;
  flows.reserve(tallies.size());
  for (const auto& [key, tally] : tallies) {
    flows.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), std::get<3>(key),
                     tally.messages, tally.evidence});
  }
  std::ranges::stable_sort(flows, std::ranges::greater{}, &TopicFlow::messages);
  return flows;
}

/// "64 of 12608 bytes on /ouster/lidar_packets, 10 on /points (sensor_msgs/PointCloud2), ...".
std::string list_flows(const std::vector<TopicFlow>& flows) {
  constexpr std::size_t kListed = 5;
  std::string list;
  for (const TopicFlow& flow : flows) {
    if (&flow == flows.data() + kListed) return list + ", ...";
    list += fmt::format("{}{}", list.empty() ? "" : ", ", flow.messages);
    list += flow.bytes > 0 ? fmt::format(" of {} bytes on {}", flow.bytes, flow.topic)
                           : fmt::format(" on {} ({})", flow.topic, flow.type);
  }
  return list;
}

[[noreturn]] void no_packets(const TopicSurvey& survey, const std::filesystem::path& file,
                             const SensorInfo& info, const PacketFormat& format,
                             std::string_view prefix) {
  if (survey.messages == 0) {
    throw InputError(fmt::format("The recording {} holds no messages.{}{}", file.string(),
                                 survey.problem.empty() ? "" : " ", survey.problem));
  }
  const bool any =
      std::ranges::any_of(survey.flows, [](const TopicFlow& f) { return f.bytes > 0; });
  if (!any) {
    throw InputError(
        fmt::format("The recording {} holds no sensor packets, but {}; record the driver's "
                    "lidar_packets and imu_packets topics (type PacketMsg), not the points made "
                    "from them.",
                    file.string(), list_flows(survey.flows)));
  }
  throw InputError(fmt::format(
      "The recording {} has no lidar packet of this sensor{}: its metadata ({}, {}, {} beams) "
      "predicts {} bytes, but the recording has {}; the metadata is likely another sensor's or of "
      "another lidar profile, so give the right one with --meta{}.",
      file.string(), prefix.empty() ? "" : fmt::format(" on topics that begin with {}", prefix),
      to_string(info.profile), info.lidar_mode, info.pixels_per_column, format.packet_bytes,
      list_flows(survey.flows), prefix.empty() ? "" : " or another --topic"));
}

/// The namespace of the metadata with the sensor's serial number: of two sensors whose packets look
/// alike, it tells which one is meant. Empty if there is none.
std::string_view namespace_with_metadata(const TopicSurvey& survey, const SensorInfo& info) {
  if (info.serial_number.empty()) return {};
  for (const RecordedMetadata& metadata : survey.metadata) {
    try {
      const SensorInfo recorded = parse_sensor_info(metadata.json, metadata.topic);
      if (recorded.serial_number == info.serial_number) return namespace_of(metadata.topic);
    } catch (const InputError&) {
      // Somebody's text that is no metadata after all.
    }
  }
  return {};
}

const TopicFlow& best_flow(const std::vector<TopicFlow>& flows, std::string_view preferred) {
  const auto found = std::ranges::find_if(flows, [&](const TopicFlow& flow) {
    return !preferred.empty() && namespace_of(flow.topic) == preferred;
  });
  return found != flows.end() ? *found : flows.front();
}

void find_imu_topic(const TopicSurvey& survey, const PacketFormat& format, std::string_view prefix,
                    SensorTopics& found) {
  const TopicFlow* elsewhere = nullptr;
  for (const TopicFlow& flow : survey.flows) {
    if (!has_size(flow.bytes, format.imu_packet_bytes) || !flow.topic.starts_with(prefix)) continue;
    if (namespace_of(flow.topic) == namespace_of(found.lidar)) {
      found.imu = flow.topic;
      return;
    }
    if (elsewhere == nullptr) elsewhere = &flow;
  }
  if (elsewhere == nullptr) return;
  found.imu = elsewhere->topic;
  found.notices.push_back(
      fmt::format("IMU packets are taken from {}, in another namespace than the lidar packets on "
                  "{}.",
                  found.imu, found.lidar));
}

}  // namespace

TopicSurvey survey_topics(const std::filesystem::path& file, const PacketFormat* format) {
  const std::unique_ptr<MessageReader> reader = open_messages(file);
  MessageDecoder decoder;
  TopicSurvey survey;
  FlowTallies tallies;
  std::uint64_t packets_since_first = 0;
  Message message;
  while (packets_since_first <= kSurveyPackets && reader->next(message)) {
    FlowKey key{message.topic, message.type, 0, 0};
    std::optional<PacketView> view;
    if (is_packet_type(message.type)) {
      const ByteSpan packet = decoder.packet(message).value_or(ByteSpan());
      std::get<2>(key) = packet.size();
      const bool expected = format != nullptr && has_size(packet.size(), format->packet_bytes);
      if (expected) {
        view = PacketView::parse(*format, packet.first(format->packet_bytes));
        if (view) std::get<3>(key) = view->serial_number();
      }
      if (expected || packets_since_first > 0) ++packets_since_first;
    } else if (survey.metadata.size() < kMaxMetadata) {
      add_metadata(message, decoder, survey.metadata);
    }
    if (tallies.size() < kMaxFlows || tallies.contains(key)) {
      FlowTally& tally = tallies[key];
      ++tally.messages;
      if (view) tally.evidence.add(*view);
    }
    if (survey.messages++ == 0) survey.first_time = message.host_time;
    survey.last_time = message.host_time;
  }
  survey.flows = sorted_flows(tallies);
  survey.problem = reader->problem();
  return survey;
}

SensorTopics find_sensor_topics(const TopicSurvey& survey, const std::filesystem::path& file,
                                const SensorInfo& info, const PacketFormat& format,
                                std::string_view prefix) {
  std::vector<TopicFlow> flows = survey.flows;
  std::erase_if(flows, [&](const TopicFlow& flow) {
    return !has_size(flow.bytes, format.packet_bytes) || !flow.topic.starts_with(prefix);
  });
  if (flows.empty()) no_packets(survey, file, info, format, prefix);

  SensorTopics found;
  found.serial = expected_serial(info, format);
  const auto is_other = [&](const TopicFlow& flow) {
    return found.serial != 0 && flow.serial != 0 && flow.serial != found.serial;
  };
  // If all are, they contradict the metadata.
  if (!std::ranges::all_of(flows, is_other)) std::erase_if(flows, is_other);
  const TopicFlow& best = best_flow(flows, namespace_with_metadata(survey, info));
  const std::string contradiction = metadata_contradiction(
      info, best.evidence, fmt::format("The lidar packets in {}", file.string()));
  if (!contradiction.empty()) throw MetadataError(contradiction);
  found.lidar = best.topic;
  for (const TopicFlow& flow : flows) {
    if (flow.topic == found.lidar) continue;
    found.notices.push_back(
        fmt::format("Both {} and {} carry packets of {} bytes; those of {} are used, --topic picks "
                    "the other.",
                    found.lidar, flow.topic, format.packet_bytes, found.lidar));
  }
  find_imu_topic(survey, format, prefix, found);
  return found;
}

}  // namespace glint::recording
