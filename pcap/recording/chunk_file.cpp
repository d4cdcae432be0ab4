// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/chunk_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace glint::recording {

ByteSpan ChunkFile::read(std::uint64_t size) {
  file_.read(size, record_);
  if (record_.size() < size) break_off("a record is cut short");
  return record_;
}

void ChunkFile::skip(std::uint64_t size) {
  if (!file_.skip(size)) break_off("a record is cut short");
}

void ChunkFile::open_chunk(Compression compression, ByteSpan packed) {
  const Inflated inflated = inflater_.inflate(compression, packed);
  chunk_ = ByteReader(inflated.bytes);
  // One that the end of the file cut short is told of as such.
  if (!inflated.whole && !broken_off()) count_damaged_chunk();
  chunk_whole_ = inflated.whole && !broken_off();
}

void ChunkFile::abandon_chunk() {
  chunk_ = {};
  if (chunk_whole_) count_damaged_chunk();
  chunk_whole_ = false;
}

void ChunkFile::break_off(std::string why) {
  if (broken_off()) return;
  break_reason_ = std::move(why);
  broken_off_at_ = file_.position();
}

std::string ChunkFile::problem() const {
  std::string text;
  if (broken_off()) {
    text = fmt::format("The recording {} breaks off after {} bytes ({}); what came before is used.",
                       path_.string(), broken_off_at_, break_reason_);
  } else if (unfinished_) {
    text = fmt::format("The recording {} was never finished by its recorder; all of it is used.",
                       path_.string());
  }
  if (damaged_chunks_ > 0) {
    text += fmt::format(
        "{}{} chunks of the recording {} are damaged or too large and were left "
        "out, in whole or in part.",
        text.empty() ? "" : " ", damaged_chunks_, path_.string());
  }
  return text;
}

}  // namespace glint::recording
