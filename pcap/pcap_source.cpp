// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/pcap_source.hpp"

#include <utility>

#include "driver/core/packet_view.hpp"

namespace glint {
namespace {

/// Packets whose type or serial cannot be told are let through: the assembler judges and counts.
bool is_other_serial(const PacketFormat& format, std::uint64_t serial,
                     std::span<const std::byte> bytes) {
  if (serial == 0) return false;
  const auto view = PacketView::parse(format, bytes);
  return view && view->serial_number() != 0 && view->serial_number() != serial;
}

}  // namespace

PcapSource::PcapSource(const std::filesystem::path& file, const SensorInfo& info,
                       PcapSourceOptions options)
    : format_(info),
      pacer_(std::move(options.pacer)),
      reader_(file),
      flow_(
          find_sensor_flow(survey_flows(file, &format_), file, info, format_, options.source_ip)) {}

SourceStatus PcapSource::read(RawPacket& packet) {
  if (stopped_) return SourceStatus::kEnd;
  if (pending_ == nullptr) pending_ = next_accepted();
  if (pending_ == nullptr) return SourceStatus::kEnd;
  if (pacer_ && !pacer_(pending_->host_time)) return SourceStatus::kIdle;
  packet.host_time = pending_->host_time;
  packet.port = pending_->destination.port;
  packet.bytes.assign(pending_->payload.begin(), pending_->payload.end());
  pending_ = nullptr;
  return SourceStatus::kPacket;
}

const Datagram* PcapSource::next_accepted() {
  while (!ended_) {
    const Datagram* const datagram = reader_.next();
    if (datagram == nullptr) {
      ended_ = true;
      if (!reader_.problem().empty()) flow_.notices.push_back(reader_.problem());
    } else if (accept(*datagram)) {
      return datagram;
    }
  }
  return nullptr;
}

/// Counts the datagram; true if it is this sensor's.
bool PcapSource::accept(const Datagram& datagram) {
  const std::uint16_t port = datagram.destination.port;
  const bool on_lidar_port = port == flow_.lidar_port;
  const bool on_imu_port = port == flow_.imu_port;
  if (!on_lidar_port && !on_imu_port) {
    ++counters_.other_ports;
    return false;
  }
  const bool is_lidar = on_lidar_port && datagram.payload.size() == format_.packet_bytes;
  const bool is_imu = datagram.payload.size() == format_.imu_packet_bytes;
  if (datagram.source.address != flow_.source ||
      (is_lidar && is_other_serial(format_, flow_.serial, datagram.payload))) {
    ++counters_.other_sensors;
    return false;
  }
  if (!is_lidar && !is_imu) {
    ++counters_.wrong_size;
    return false;
  }
  ++(is_lidar ? counters_.lidar_packets : counters_.imu_packets);
  return true;
}

}  // namespace glint
