// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/capture_json.hpp"

#include "pcap/recording/recording_source.hpp"

namespace glint::cli {

using Json = nlohmann::ordered_json;

Json to_json(const AssemblerCounters& c) {
  return {{"packets", c.packets},
          {"imu_packets", c.imu_packets},
          {"zone_packets", c.zone_packets},
          {"bad_size", c.bad_size},
          {"bad_type", c.bad_type},
          {"bad_serial", c.bad_serial},
          {"corrupt_packets", c.corrupt_packets},
          {"crc_mismatches", c.crc_mismatches},
          {"bad_columns", c.bad_column},
          {"late_packets", c.late_packets},
          {"duplicate_packets", c.duplicate_packets},
          {"stray_packets", c.stray_packets},
          {"missing_packets", c.missing_packets},
          {"clock_jumps", c.clock_jumps},
          {"restarts", c.restarts},
          {"scans", c.scans},
          {"incomplete_scans", c.incomplete_scans}};
}

Json to_json(const PcapSourceCounters& c) {
  return {{"lidar_packets", c.lidar_packets},
          {"imu_packets", c.imu_packets},
          {"other_sensors", c.other_sensors},
          {"wrong_size", c.wrong_size},
          {"other_ports", c.other_ports}};
}

Json to_json(const CaptureCounters& c) {
  const ReassemblyCounters& r = c.reassembly;
  return {{"records", c.records},
          {"whole_datagrams", c.whole_datagrams},
          {"fragments", c.fragments},
          {"other_protocols", c.other_protocols},
          {"truncated_records", c.truncated_records},
          {"malformed_records", c.malformed_records},
          {"reassembly",
           {{"datagrams", r.datagrams},
            {"malformed_fragments", r.malformed_fragments},
            {"duplicate_fragments", r.duplicate_fragments},
            {"stray_fragments", r.stray_fragments},
            {"bad_checksums", r.bad_checksums},
            {"timed_out", r.timed_out},
            {"evicted", r.evicted}}}};
}

Json source_json(const PacketSource& source) {
  if (const auto* pcap = dynamic_cast<const PcapSource*>(&source)) {
    return to_json(pcap->counters());
  }
  if (const auto* messages = dynamic_cast<const recording::RecordingSource*>(&source)) {
    const recording::RecordingSourceCounters& c = messages->counters();
    return {{"lidar_packets", c.lidar_packets}, {"imu_packets", c.imu_packets},
            {"other_sensors", c.other_sensors}, {"wrong_size", c.wrong_size},
            {"malformed", c.malformed},         {"other_topics", c.other_topics}};
  }
  return nullptr;
}

Json capture_json(const PacketSource& source) {
  const auto* pcap = dynamic_cast<const PcapSource*>(&source);
  return pcap == nullptr ? Json(nullptr) : to_json(pcap->capture_counters());
}

}  // namespace glint::cli
