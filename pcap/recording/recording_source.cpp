// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/recording_source.hpp"

#include <utility>

#include "driver/core/packet_view.hpp"
#include "pcap/recording/message_files.hpp"

namespace glint::recording {

RecordingSource::RecordingSource(const std::filesystem::path& path, const SensorInfo& info,
                                 RecordingSourceOptions options)
    : format_(info),
      lidar_port_(static_cast<std::uint16_t>(info.lidar_port)),
      imu_port_(static_cast<std::uint16_t>(info.imu_port)),
      pacer_(std::move(options.pacer)),
      topics_(find_sensor_topics(survey_topics(path, &format_), path, info, format_,
                                 options.topic_prefix)),
      reader_(open_messages(path)) {}

SourceStatus RecordingSource::read(RawPacket& packet) {
  if (stopped_ || (!pending_ && !next_accepted())) return SourceStatus::kEnd;
  if (pacer_ && !pacer_(pending_->host_time)) return SourceStatus::kIdle;
  packet.host_time = pending_->host_time;
  packet.port = pending_->port;
  packet.bytes.assign(pending_->bytes.begin(), pending_->bytes.end());
  pending_.reset();
  return SourceStatus::kPacket;
}

bool RecordingSource::next_accepted() {
  Message message;
  while (!ended_) {
    if (!reader_->next(message)) {
      ended_ = true;
      const std::string problem = reader_->problem();
      if (!problem.empty()) topics_.notices.push_back(problem);
    } else if (accept(message)) {
      return true;
    }
  }
  return false;
}

/// Counts the message; true if it holds a packet of this sensor, which is then pending.
bool RecordingSource::accept(const Message& message) {
  if (!is_packet_type(message.type)) {
    ++counters_.other_topics;
    return false;
  }
  const std::optional<ByteSpan> packet = decoder_.packet(message);
  if (!packet) {
    ++counters_.malformed;
    return false;
  }
  if (!accept_packet(message.topic, *packet)) return false;
  pending_->host_time = message.host_time;
  return true;
}

bool RecordingSource::accept_packet(std::string_view topic, ByteSpan packet) {
  if (topic != topics_.lidar && topic != topics_.imu) {
    ++counters_.other_sensors;
    return false;
  }
  const bool is_lidar = topic == topics_.lidar && has_size(packet.size(), format_.packet_bytes);
  if (!is_lidar && !has_size(packet.size(), format_.imu_packet_bytes)) {
    ++counters_.wrong_size;
    return false;
  }
  const ByteSpan bytes = packet.first(is_lidar ? format_.packet_bytes : format_.imu_packet_bytes);
  const auto view = is_lidar ? PacketView::parse(format_, bytes) : std::nullopt;
  const std::uint64_t serial = view ? view->serial_number() : 0;
  if (topics_.serial != 0 && serial != 0 && serial != topics_.serial) {
    ++counters_.other_sensors;
    return false;
  }
  ++(is_lidar ? counters_.lidar_packets : counters_.imu_packets);
  pending_ = Pending{{}, is_lidar ? lidar_port_ : imu_port_, bytes};
  return true;
}

}  // namespace glint::recording
