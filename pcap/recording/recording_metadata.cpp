// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/recording_metadata.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "driver/core/error.hpp"
#include "pcap/recording/message_files.hpp"
#include "pcap/recording/osf_file.hpp"

namespace glint::recording {
namespace {

constexpr std::uint64_t kMaxPackets = 16384;

bool is_json_object(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

}  // namespace

void add_metadata(const Message& message, MessageDecoder& decoder,
                  std::vector<RecordedMetadata>& found) {
  const std::string_view name = message.topic.substr(namespace_of(message.topic).size());
  if (!is_text_type(message.type) || name.find("metadata") == std::string_view::npos) return;
  const bool known = std::ranges::any_of(
      found, [&](const RecordedMetadata& metadata) { return metadata.topic == message.topic; });
  if (known) return;
  const std::optional<std::string_view> text = decoder.text(message);
  if (text && is_json_object(*text)) {
    found.push_back({std::string(message.topic), std::string(*text)});
  }
}

std::optional<std::string> find_metadata(const std::filesystem::path& path,
                                         std::string_view prefix) {
  if (recording_format(path) == RecordingFormat::kOsf) {
    std::optional<OsfContents> contents = read_osf(path);
    // To ask the user for metadata would be vain: there are no packets to use them with.
    if (!contents || !contents->sensor) throw InputError(osf_refusal(path, path));
    return std::move(contents->sensor);
  }
  const std::unique_ptr<MessageReader> reader = open_messages(path);
  MessageDecoder decoder;
  std::vector<RecordedMetadata> found;
  std::uint64_t packets = 0;
  Message message;
  while (packets < kMaxPackets && reader->next(message)) {
    if (!message.topic.starts_with(prefix)) continue;
    if (is_packet_type(message.type)) ++packets;
    add_metadata(message, decoder, found);
    if (!found.empty()) return found.front().json;
  }
  return std::nullopt;
}

}  // namespace glint::recording
