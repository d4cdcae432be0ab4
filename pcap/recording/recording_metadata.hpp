// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcap/recording/message.hpp"
#include "pcap/recording/message_decoder.hpp"

namespace glint::recording {

/// Sensor metadata found in a recording.
struct RecordedMetadata {
  std::string topic;
  std::string json;
};

/// Adds what a message says if it is a sensor's metadata (a String of JSON on a topic named
/// metadata) and the first on its topic.
void add_metadata(const Message& message, MessageDecoder& decoder,
                  std::vector<RecordedMetadata>& found);

/// The sensor metadata, as JSON, found inside a recording: the first of topics that begin with
/// `prefix`, or an OSF file's. Null if there is none, as in bags before 2021. Drivers publish it as
/// they start, so it is looked for only some ten seconds into a sensor's packets.
/// @throws InputError if the recording cannot be read, or is an OSF file without sensor metadata.
std::optional<std::string> find_metadata(const std::filesystem::path& path,
                                         std::string_view prefix = {});

}  // namespace glint::recording
