// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "driver/core/assembler_counters.hpp"
#include "driver/core/crc_trust.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/packet_view.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// What a datagram is.
enum class PacketVerdict {
  kLidar,
  kImu,
  kZone,      ///< Zone monitoring's; nothing here reads it.
  kBadSize,   ///< Not the size of any of the sensor's packets.
  kBadType,   ///< Of a packet's size, but its type field says otherwise.
  kForeign,   ///< Another sensor's serial number.
  kCorrupt,   ///< Its CRC does not match, in a stream whose CRCs do.
  kOutdated,  ///< A lidar packet sent before the sensor's restart and overtaken by it.
};

/// Tells the packets of one sensor's present run from everything else that arrives, by size, type,
/// header layout, serial number, CRC and init id. Learns three things from the packets: where the
/// header has its fields, whether CRCs can be believed, and the init id.
/// Thread-compatible. Does not allocate and does not throw.
class PacketGate {
 public:
  struct Decision {
    PacketVerdict verdict;
    std::optional<PacketView> packet;  ///< With kLidar only.
    bool restarted = false;            ///< The first packet after a restart of the sensor.
  };

  explicit PacketGate(const SensorInfo& info);

  /// Decides on one datagram and counts it, but for lidar packets, kOutdated ones included: what
  /// becomes of them is for others to say.
  Decision decide(std::span<const std::byte> datagram, AssemblerCounters& counters);
  /// The sensor was replaced by one of its kind, or its metadata read anew: whose packets are taken
  /// from here on.
  void set_identity(const SensorInfo& info);
  /// The next init id is the sensor's, whatever it is.
  void forget_init_id() { init_id_ = former_init_id_ = 0; }

  [[nodiscard]] const PacketFormat& format() const { return format_; }
  /// State and alerts of the sensor as the latest lidar packet has them; null before the first one
  /// and for legacy packets, which do not say.
  [[nodiscard]] const std::optional<PacketHealth>& health() const { return health_; }

 private:
  // A type of packet that the sensor sends.
  struct Kind {
    PacketVerdict verdict;
    std::size_t bytes;
    std::uint16_t type;
    bool has_header;  // with type, ids and CRC; legacy ones have none
    CrcTrust crc = {};
  };

  PacketVerdict classify(std::span<const std::byte> datagram, AssemblerCounters& counters);
  std::optional<PacketHeader> header_of(std::span<const std::byte> datagram,
                                        std::uint16_t type) const;
  PacketVerdict judge(std::span<const std::byte> packet, PacketHeader header, Kind& kind,
                      AssemblerCounters& counters);
  bool take_init_id(std::uint32_t id, bool& restarted);

  PacketFormat format_;              // constant but for the header, which packets may prove
  std::uint64_t serial_number_ = 0;  // 0: not known
  std::uint32_t metadata_init_id_ = 0;
  std::array<Kind, 3> kinds_;
  std::uint32_t init_id_ = 0;
  std::uint32_t former_init_id_ = 0;
  std::optional<PacketHealth> health_;
};

}  // namespace glint
