// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>
#include <string_view>

#include "pcap/recording/inflater.hpp"
#include "pcap/recording/message.hpp"

namespace glint::recording {

/// Takes sensor data out of messages, serialised by ROS 1 or as CDR of either byte order, and
/// messages that were packed one by one with zstd. What it returns is valid until the next call,
/// and while the message is. Thread-compatible.
class MessageDecoder {
 public:
  /// The packet in a message of a type for which is_packet_type() holds; null if it is malformed.
  std::optional<ByteSpan> packet(const Message& message);
  /// The text in a message of a type for which is_text_type() holds; null if it is malformed.
  std::optional<std::string_view> text(const Message& message);

 private:
  Inflater inflater_;
};

}  // namespace glint::recording
