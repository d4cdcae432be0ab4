// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/core/packet_format.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"
#include "pcap/pcap_source.hpp"
#include "pcap/recording/message.hpp"
#include "pcap/recording/message_decoder.hpp"
#include "pcap/recording/topic_survey.hpp"

namespace glint::recording {

struct RecordingSourceOptions {
  /// Only topics that begin with this, e.g. "/os_front/". Without it, of several that fit, that
  /// beside the sensor's metadata is taken, else the one with most packets, which notices() says.
  std::string topic_prefix;
  /// None: packets come as fast as they are read, always the same and without loss.
  Pacer pacer;
};

/// What became of the recording's messages.
struct RecordingSourceCounters {
  std::uint64_t lidar_packets = 0;  ///< Handed out.
  std::uint64_t imu_packets = 0;    ///< Handed out.
  std::uint64_t other_sensors = 0;  ///< Packets on other topics, or of another serial number.
  std::uint64_t wrong_size = 0;     ///< On the sensor's topics, but of no known packet size.
  std::uint64_t malformed = 0;      ///< Packet messages that contradict themselves.
  std::uint64_t other_topics = 0;   ///< Messages of types that hold no packets.
};

/// Replays one sensor's lidar and IMU packets from a ROS 1 bag, a ROS 2 bag or an MCAP file, as
/// PcapSource does from a capture: in file order, at the times when they were recorded. A packet's
/// port is the one that metadata says. Thread-compatible, except that stop() may be called from any
/// thread.
class RecordingSource final : public PacketSource {
 public:
  /// Looks through the recording for the sensor's topics.
  /// @throws InputError if it cannot be read, is no recording, or is without the sensor's packets.
  RecordingSource(const std::filesystem::path& path, const SensorInfo& info,
                  RecordingSourceOptions options = {});

  SourceStatus read(RawPacket& packet) override;
  void stop() override { stopped_ = true; }

  /// What a user should know: a second sensor, IMU packets of another namespace, and, once the end
  /// is reached, what of the recording could not be read.
  [[nodiscard]] std::vector<std::string> notices() const override { return topics_.notices; }
  [[nodiscard]] const SensorTopics& topics() const { return topics_; }
  [[nodiscard]] const RecordingSourceCounters& counters() const { return counters_; }

 private:
  bool next_accepted();
  bool accept(const Message& message);
  bool accept_packet(std::string_view topic, ByteSpan packet);

  const PacketFormat format_;
  const std::uint16_t lidar_port_;
  const std::uint16_t imu_port_;
  const Pacer pacer_;
  SensorTopics topics_;
  const std::unique_ptr<MessageReader> reader_;
  MessageDecoder decoder_;
  RecordingSourceCounters counters_;
  struct Pending {
    HostTime host_time;
    std::uint16_t port = 0;
    ByteSpan bytes;
  };
  std::optional<Pending> pending_;  ///< Read, but not yet due.
  bool ended_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace glint::recording
