// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_gate.hpp"

#include <charconv>
#include <string>

#include "driver/core/imu_packet_layout.hpp"
#include "driver/core/packet_fields.hpp"

namespace glint {
namespace {

std::uint64_t parse_serial_number(const std::string& text) {
  std::uint64_t serial = 0;
  std::from_chars(text.data(), text.data() + text.size(), serial);
  return serial;
}

// Null: whoever takes lidar packets counts it.
std::uint64_t* counter_of(PacketVerdict verdict, AssemblerCounters& counters) {
  switch (verdict) {
    case PacketVerdict::kImu:
      return &counters.imu_packets;
    case PacketVerdict::kZone:
      return &counters.zone_packets;
    case PacketVerdict::kBadSize:
      return &counters.bad_size;
    case PacketVerdict::kBadType:
      return &counters.bad_type;
    case PacketVerdict::kForeign:
      return &counters.bad_serial;
    case PacketVerdict::kCorrupt:
      return &counters.corrupt_packets;
    case PacketVerdict::kLidar:
    case PacketVerdict::kOutdated:
      break;
  }
  return nullptr;
}

}  // namespace

PacketGate::PacketGate(const SensorInfo& info)
    : format_(info),
      kinds_{{{PacketVerdict::kLidar, format_.packet_bytes, kLidarPacketType, !format_.legacy()},
              {PacketVerdict::kImu, format_.imu_packet_bytes, kImuPacketType,
               info.imu_profile != ImuProfile::kLegacy},
              {PacketVerdict::kZone, kZonePacketBytes, kZonePacketType, true}}} {
  set_identity(info);
}

void PacketGate::set_identity(const SensorInfo& info) {
  serial_number_ = parse_serial_number(info.serial_number);
  metadata_init_id_ = info.init_id;
}

PacketGate::Decision PacketGate::decide(std::span<const std::byte> datagram,
                                        AssemblerCounters& counters) {
  Decision decision{classify(datagram, counters), std::nullopt};
  if (std::uint64_t* counter = counter_of(decision.verdict, counters)) ++*counter;
  if (decision.verdict != PacketVerdict::kLidar) return decision;
  const auto packet = PacketView::parse(format_, datagram);
  if (!take_init_id(packet->init_id(), decision.restarted)) {
    decision.verdict = PacketVerdict::kOutdated;
    return decision;
  }
  if (!format_.legacy()) health_ = packet->health();
  decision.packet = packet;
  return decision;
}

PacketVerdict PacketGate::classify(std::span<const std::byte> datagram,
                                   AssemblerCounters& counters) {
  bool size_known = false;
  for (Kind& kind : kinds_) {
    if (datagram.size() != kind.bytes) continue;
    if (!kind.has_header) return kind.verdict;
    if (const auto header = header_of(datagram, kind.type)) {
      return judge(datagram, *header, kind, counters);
    }
    size_known = true;
  }
  return size_known ? PacketVerdict::kBadType : PacketVerdict::kBadSize;
}

// The manual gives two layouts for one profile, so the sensor's ids decide, where they are known;
// else metadata or what earlier packets showed.
std::optional<PacketHeader> PacketGate::header_of(std::span<const std::byte> datagram,
                                                  std::uint16_t type) const {
  const PacketHeader header =
      recognise_header(datagram, serial_number_, metadata_init_id_, type).value_or(format_.header);
  if (packet_type(header_layout(header), datagram.data()) != type) return std::nullopt;
  return header;
}

// What a packet of the right size and type is. The serial number comes first: the CRCs of other
// sensors say nothing of this one's.
PacketVerdict PacketGate::judge(std::span<const std::byte> packet, PacketHeader header, Kind& kind,
                                AssemblerCounters& counters) {
  const std::uint64_t serial = packet_serial_number(header_layout(header), packet.data());
  if (serial != 0 && serial_number_ != 0 && serial != serial_number_) {
    return PacketVerdict::kForeign;
  }
  const bool matches = packet_crc_matches(packet);
  if (!matches) ++counters.crc_mismatches;
  if (!kind.crc.accept(matches)) return PacketVerdict::kCorrupt;
  if (kind.verdict == PacketVerdict::kLidar) format_.header = header;
  return kind.verdict;
}

// A new init id is a restarted sensor. False: the packet was sent before the restart and overtaken.
bool PacketGate::take_init_id(std::uint32_t id, bool& restarted) {
  if (id == 0 || id == init_id_) return true;
  if (id == former_init_id_) return false;
  restarted = init_id_ != 0;
  former_init_id_ = init_id_;
  init_id_ = id;
  return true;
}

}  // namespace glint
