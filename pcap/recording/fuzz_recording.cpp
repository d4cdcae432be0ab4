// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/fuzz_recording.hpp"

#include <fstream>
#include <memory>

#include "driver/core/error.hpp"
#include "pcap/recording/message_decoder.hpp"
#include "pcap/recording/message_files.hpp"
#include "pcap/recording/osf_file.hpp"
#include "pcap/recording/recording_metadata.hpp"
#include "pcap/recording/unpacked_file.hpp"

namespace glint::recording {

void fuzz_recording(ByteSpan contents) {
  // In a file, a checksum lets little of what is damaged pass.
  static_cast<void>(parse_osf_metadata(contents));
  const TemporaryFile file;
  const std::string_view text = as_text(contents);
  std::ofstream(file.path(), std::ios::binary)
      .write(text.data(), static_cast<std::streamsize>(text.size()));
  try {
    static_cast<void>(find_metadata(file.path()));
    const std::unique_ptr<MessageReader> reader = open_messages(file.path());
    MessageDecoder decoder;
    Message message;
    while (reader->next(message)) static_cast<void>(decoder.packet(message));
    static_cast<void>(reader->problem());
  } catch (const InputError&) {
    // The verdict that most inputs deserve.
  }
}

}  // namespace glint::recording
