// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/message_decoder.hpp"

namespace glint::recording {
namespace {

/// What follows a CDR message's header of two bytes that say the representation and two of
/// options. XCDR 1 and 2 write the messages of interest alike. Null for representations with
/// member headers, which ROS does not use.
std::optional<ByteReader> cdr_body(ByteSpan bytes) {
  ByteReader header(bytes, true);
  const auto representation = header.integer<std::uint16_t>();
  static_cast<void>(header.bytes(2));
  const bool big_endian = representation == 0 || representation == 6;
  const bool little_endian = representation == 1 || representation == 7;
  if (!header.ok() || !(big_endian || little_endian)) return std::nullopt;
  return ByteReader(header.rest(), big_endian);
}

/// The bytes of a message that is one vector of bytes or one string: a length, and they.
std::optional<ByteSpan> only_member(const Message& message, Inflater& inflater) {
  ByteReader reader(message.bytes);
  if (message.encoding == Encoding::kCdr) {
    ByteSpan bytes = message.bytes;
    if (is_zstd(bytes)) {
      const Inflated inflated = inflater.inflate(Compression::kZstd, bytes);
      if (!inflated.whole) return std::nullopt;
      bytes = inflated.bytes;
    }
    const std::optional<ByteReader> body = cdr_body(bytes);
    if (!body) return std::nullopt;
    reader = *body;
  } else if (message.encoding != Encoding::kRos1) {
    return std::nullopt;
  }
  const ByteSpan member = reader.bytes(reader.integer<std::uint32_t>());
  if (!reader.ok()) return std::nullopt;
  return member;
}

}  // namespace

std::optional<ByteSpan> MessageDecoder::packet(const Message& message) {
  return only_member(message, inflater_);
}

std::optional<std::string_view> MessageDecoder::text(const Message& message) {
  const std::optional<ByteSpan> member = only_member(message, inflater_);
  if (!member) return std::nullopt;
  std::string_view text = as_text(*member);
  // CDR counts the zero that ends a string.
  if (message.encoding == Encoding::kCdr && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

}  // namespace glint::recording
