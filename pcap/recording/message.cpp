// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/message.hpp"

namespace glint::recording {

// The package has been called ouster_ros, ouster_sensor_msgs and ouster_msgs; the layout stayed.
bool is_packet_type(std::string_view type) { return type.ends_with("/PacketMsg"); }

bool is_text_type(std::string_view type) {
  return type == "std_msgs/String" || type == "std_msgs/msg/String";
}

bool carries_sensor_data(std::string_view type) {
  return is_packet_type(type) || is_text_type(type);
}

std::string_view namespace_of(std::string_view topic) {
  return topic.substr(0, topic.rfind('/') + 1);
}

}  // namespace glint::recording
