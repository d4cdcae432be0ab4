// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "driver/core/time.hpp"
#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

/// How a message's bytes are laid out.
enum class Encoding {
  kRos1,
  kCdr,    ///< ROS 2.
  kOther,  ///< None that is understood here.
};

/// Longer names of topics and types are damage.
constexpr std::size_t kMaxNameBytes = 1024;

/// One recorded message. Non-owning: valid until the reader's next call.
struct Message {
  std::string_view topic;  ///< e.g. "/ouster/lidar_packets".
  std::string_view type;   ///< e.g. "ouster_ros/PacketMsg" (ROS 1), "std_msgs/msg/String" (ROS 2).
  Encoding encoding = Encoding::kOther;
  HostTime host_time;  ///< When the recorder received it.
  /// Serialised. May be empty if the type is of no interest, see carries_sensor_data().
  ByteSpan bytes;
};

/// Reads the messages of one recording, in the order in which they were stored.
/// Thread-compatible.
class MessageReader {
 public:
  MessageReader() = default;
  virtual ~MessageReader() = default;
  MessageReader(const MessageReader&) = delete;
  MessageReader& operator=(const MessageReader&) = delete;

  /// Reads the next message; false at the end, or where the recording breaks off.
  virtual bool next(Message& message) = 0;
  /// A sentence on what could not be read; empty if all could. Complete once next() was false.
  [[nodiscard]] virtual std::string problem() const = 0;
};

/// Whether a message type may hold sensor packets: any package's PacketMsg.
bool is_packet_type(std::string_view type);
/// Whether a message type may hold sensor metadata: std_msgs' String.
bool is_text_type(std::string_view type);
/// Whether a message type is of interest here at all.
bool carries_sensor_data(std::string_view type);

/// A topic's name up to and with its last slash.
std::string_view namespace_of(std::string_view topic);

}  // namespace glint::recording
