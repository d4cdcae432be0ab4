// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/flow_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <tuple>

#include "driver/core/error.hpp"
#include "driver/core/packet_view.hpp"
#include "driver/core/profile_names.hpp"

namespace glint {
namespace {

constexpr std::size_t kMaxFlows = 1024;
/// Datagrams read after the sensor's first: a second or two, in which a second sensor shows itself.
/// They are read again afterwards, so more would be felt.
constexpr std::uint64_t kSurveyDatagrams = 1024;

using FlowKey = std::tuple<IpAddress, std::uint16_t, std::size_t, std::uint64_t>;

struct FlowTally {
  std::uint64_t datagrams = 0;
  PacketEvidence evidence;
};
using FlowTallies = std::map<FlowKey, FlowTally>;

std::vector<Flow> sorted_flows(const FlowTallies& tallies) {
  std::vector<Flow> flows;
  flows.reserve(tallies.size());
  for (const auto& [key, tally] : tallies) {
    flows.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), std::get<3>(key),
                     tally.datagrams, tally.evidence});
  }
  std::ranges::stable_sort(flows, std::ranges::greater{}, &Flow::datagrams);
  return flows;
}

/// Counts a datagram among those like it; `packet` is what it holds, if that was looked for.
void tally(const Datagram& datagram, const std::optional<PacketView>& packet,
           FlowTallies& tallies) {
  const FlowKey key{datagram.source.address, datagram.destination.port, datagram.payload.size(),
                    packet ? packet->serial_number() : 0};
  if (tallies.size() >= kMaxFlows && !tallies.contains(key)) return;
  FlowTally& tally = tallies[key];
  ++tally.datagrams;
  if (packet) tally.evidence.add(*packet);
}

/// "64 of 8448 bytes to port 7502 from 10.0.0.7, ...", the largest few.
std::string list_flows(const std::vector<Flow>& flows) {
  constexpr std::size_t kListed = 5;
  std::string list;
  for (const Flow& flow : flows) {
    if (&flow == flows.data() + kListed) return list + ", ...";
    list += fmt::format("{}{} of {} bytes to port {} from {}", list.empty() ? "" : ", ",
                        flow.datagrams, flow.bytes, flow.port, to_string(flow.source));
  }
  return list;
}

std::string no_datagrams(const FlowSurvey& survey, const std::filesystem::path& file) {
  const CaptureCounters& counters = survey.counters;
  if (counters.records == 0) {
    return fmt::format(
        "The capture {} is empty: it has no records; record again while the sensor "
        "sends to this machine.{}",
        file.string(), survey.problem.empty() ? "" : " " + survey.problem);
  }
  return fmt::format(
      "The capture {} holds no whole UDP datagram in its {} records ({} of other "
      "protocols, {} truncated, {} malformed, {} fragments); record again, with full "
      "packet length (tcpdump -s 0) and no port filter, which would lose fragments.",
      file.string(), counters.records, counters.other_protocols, counters.truncated_records,
      counters.malformed_records, counters.fragments);
}

/// Of which sensors the largest flow's packets would be, in brackets; empty if nobody's.
std::string size_clause(const std::vector<Flow>& flows, int likely_beams) {
  for (const Flow& flow : flows) {
    const std::string profiles = profiles_of_size(flow.bytes, likely_beams);
    if (!profiles.empty()) return fmt::format(" ({} bytes: {})", flow.bytes, profiles);
  }
  return {};
}

std::string source_clause(const std::optional<IpAddress>& source_ip) {
  return source_ip ? fmt::format(" from {}", to_string(*source_ip)) : std::string();
}

/// The flows of the sensor's packet size, from the wanted source.
std::vector<Flow> flows_of_size(const FlowSurvey& survey, const std::filesystem::path& file,
                                const SensorInfo& info, const PacketFormat& format,
                                const std::optional<IpAddress>& source_ip) {
  std::vector<Flow> matching;
  for (const Flow& flow : survey.flows) {
    if (flow.bytes == format.packet_bytes && (!source_ip || flow.source == *source_ip)) {
      matching.push_back(flow);
    }
  }
  if (!matching.empty()) return matching;
  throw InputError(fmt::format(
      "The capture {} has no lidar packet of this sensor{}: its metadata ({}, {}, {} beams) "
      "predicts {} bytes on port {}, but the capture has {}{}; the metadata is likely another "
      "sensor's or of another lidar profile, so give the right one with --meta{}.",
      file.string(), source_clause(source_ip), to_string(info.profile), info.lidar_mode,
      info.pixels_per_column, format.packet_bytes, info.lidar_port, list_flows(survey.flows),
      size_clause(survey.flows, info.pixels_per_column),
      source_ip ? " or another --source-ip" : ""));
}

/// Leaves flows of other sensors out, unless there are no others: those contradict the metadata.
void keep_serial(std::vector<Flow>& flows, std::uint64_t serial) {
  const auto is_other = [&](const Flow& flow) { return flow.serial != 0 && flow.serial != serial; };
  if (serial != 0 && !std::ranges::all_of(flows, is_other)) std::erase_if(flows, is_other);
}

void check_metadata(const Flow& flow, const std::filesystem::path& file, const SensorInfo& info) {
  const std::string contradiction = metadata_contradiction(
      info, flow.evidence, fmt::format("The lidar packets in {}", file.string()));
  if (!contradiction.empty()) throw MetadataError(contradiction);
}

/// IMU packets carry no serial: they are those of the lidar's source address.
void find_imu_port(const FlowSurvey& survey, const SensorInfo& info, const PacketFormat& format,
                   SensorFlow& found) {
  found.imu_port = static_cast<std::uint16_t>(info.imu_port);
  const Flow* elsewhere = nullptr;
  for (const Flow& flow : survey.flows) {
    if (flow.bytes != format.imu_packet_bytes || flow.source != found.source) continue;
    if (flow.port == info.imu_port) return;
    if (elsewhere == nullptr) elsewhere = &flow;
  }
  if (elsewhere == nullptr) return;
  found.imu_port = elsewhere->port;
  found.notices.push_back(fmt::format("IMU packets found on port {}, metadata says {}.",
                                      found.imu_port, info.imu_port));
}

}  // namespace

FlowSurvey survey_flows(const std::filesystem::path& file, const PacketFormat* format) {
  CaptureReader reader(file);
  FlowSurvey survey;
  FlowTallies tallies;
  std::uint64_t since_first_packet = 0;
  while (const Datagram* datagram = reader.next()) {
    const bool expected = format != nullptr && datagram->payload.size() == format->packet_bytes;
    tally(*datagram, expected ? PacketView::parse(*format, datagram->payload) : std::nullopt,
          tallies);
    if (survey.datagrams++ == 0) survey.first_time = datagram->host_time;
    survey.last_time = datagram->host_time;
    if (expected || since_first_packet > 0) ++since_first_packet;
    if (since_first_packet > kSurveyDatagrams) break;
  }
  survey.flows = sorted_flows(tallies);
  survey.counters = reader.counters();
  survey.link_type = reader.link_type();
  survey.problem = reader.problem();
  return survey;
}

std::uint64_t expected_serial(const SensorInfo& info, const PacketFormat& format) {
  if (format.legacy()) return 0;
  std::uint64_t serial = 0;
  const char* const end = info.serial_number.data() + info.serial_number.size();
  const auto result = std::from_chars(info.serial_number.data(), end, serial);
  return result.ec == std::errc() && result.ptr == end ? serial : 0;
}

SensorFlow find_sensor_flow(const FlowSurvey& survey, const std::filesystem::path& file,
                            const SensorInfo& info, const PacketFormat& format,
                            const std::optional<IpAddress>& source_ip) {
  if (survey.datagrams == 0) throw InputError(no_datagrams(survey, file));
  std::vector<Flow> flows = flows_of_size(survey, file, info, format, source_ip);
  SensorFlow found;
  found.serial = expected_serial(info, format);
  keep_serial(flows, found.serial);

  std::vector<Flow> on_port = flows;
  std::erase_if(on_port, [&](const Flow& f) { return f.port != info.lidar_port; });
  const Flow& best = on_port.empty() ? flows.front() : on_port.front();
  check_metadata(best, file, info);
  found.source = best.source;
  found.lidar_port = best.port;
  if (on_port.empty()) {
    found.notices.push_back(
        fmt::format("Lidar packets found on port {} by their size of {} bytes, metadata says {}.",
                    best.port, best.bytes, info.lidar_port));
  }
  for (const Flow& flow : flows) {
    if (flow.port != best.port || flow.source == best.source) continue;
    found.notices.push_back(
        fmt::format("Both {} and {} send packets of {} bytes to port {}; those of {} are used, "
                    "--source-ip picks the other.",
                    to_string(best.source), to_string(flow.source), best.bytes, best.port,
                    to_string(best.source)));
  }
  find_imu_port(survey, info, format, found);
  return found;
}

}  // namespace glint
