// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "driver/core/packet_format.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"
#include "pcap/capture_reader.hpp"
#include "pcap/flow_survey.hpp"

namespace glint {

/// Waits until a packet of the given record time is due, at most about 100 ms; true when it is due.
/// Called on the reading thread. Libraries own no clock, so the caller brings it.
using Pacer = std::function<bool(HostTime)>;

struct PcapSourceOptions {
  /// Only this sender's packets. Without it, of several senders whose packets fit, the one that
  /// sends most is taken, which notices() says.
  std::optional<IpAddress> source_ip;
  /// None: packets come as fast as they are read, always the same and without loss.
  Pacer pacer;
};

/// What became of the capture's datagrams.
struct PcapSourceCounters {
  std::uint64_t lidar_packets = 0;  ///< Handed out.
  std::uint64_t imu_packets = 0;    ///< Handed out.
  std::uint64_t other_sensors = 0;  ///< Lidar or IMU packets of another address or serial number.
  std::uint64_t wrong_size = 0;     ///< On the sensor's ports, but of no known packet size.
  std::uint64_t other_ports = 0;    ///< None of the above.
};

/// Replays one sensor's lidar and legacy IMU packets from a capture, in file order.
/// Thread-compatible, except that stop() may be called from any thread.
class PcapSource : public PacketSource {
 public:
  /// Looks through the capture for the sensor's flow.
  /// @throws InputError if the file is missing, no capture, empty, or without the sensor's packets.
  PcapSource(const std::filesystem::path& file, const SensorInfo& info,
             PcapSourceOptions options = {});

  SourceStatus read(RawPacket& packet) override;
  void stop() override { stopped_ = true; }

  /// What a user should know: packets on other ports than metadata says, a second sensor, and,
  /// once the end is reached, that the capture broke off.
  [[nodiscard]] std::vector<std::string> notices() const override { return flow_.notices; }
  [[nodiscard]] const SensorFlow& flow() const { return flow_; }
  [[nodiscard]] const PcapSourceCounters& counters() const { return counters_; }
  [[nodiscard]] CaptureCounters capture_counters() const { return reader_.counters(); }
  [[nodiscard]] const std::string& link_type() const { return reader_.link_type(); }

 private:
  bool accept(const Datagram& datagram);
  const Datagram* next_accepted();

  const PacketFormat format_;
  const Pacer pacer_;
  CaptureReader reader_;
  SensorFlow flow_;
  PcapSourceCounters counters_;
  const Datagram* pending_ = nullptr;  ///< Read, but not yet due.
  bool ended_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace glint
