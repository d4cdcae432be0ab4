// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pcap/recording/byte_reader.hpp"
#include "pcap/recording/inflater.hpp"
#include "pcap/recording/input_file.hpp"

namespace glint::recording {

/// A file of records, of which chunks hold further records, packed or not: what ROS 1 bags and MCAP
/// files have in common. Keeps account of the damage. Thread-compatible.
class ChunkFile {
 public:
  /// @throws InputError if the file cannot be read.
  explicit ChunkFile(const std::filesystem::path& file) : path_(file), file_(file) {}

  /// The file's next `size` bytes; fewer at its end. Valid until the next call.
  ByteSpan read(std::uint64_t size);
  /// Leaps over a record that is not wanted.
  void skip(std::uint64_t size);
  [[nodiscard]] std::uint64_t left() const { return file_.left(); }
  [[nodiscard]] std::uint64_t position() const { return file_.position(); }

  /// Makes `packed` the chunk whose records come next.
  void open_chunk(Compression compression, ByteSpan packed);
  /// The records of the chunk, as far as they are not yet read; not ok() once one is cut short.
  ByteReader& chunk() { return chunk_; }
  /// Drops the rest of the chunk: its contents make no sense.
  void abandon_chunk();

  /// Counts a chunk of which not all can be used.
  void count_damaged_chunk() { ++damaged_chunks_; }
  /// Notes that nothing after here can be read, and why: a clause, e.g. "a record is cut short".
  void break_off(std::string why);
  /// Notes that the recorder never finished the file.
  void set_unfinished() { unfinished_ = true; }
  [[nodiscard]] bool broken_off() const { return !break_reason_.empty(); }

  /// As MessageReader::problem().
  [[nodiscard]] std::string problem() const;

 private:
  const std::filesystem::path path_;
  InputFile file_;
  Inflater inflater_;
  std::vector<std::byte> record_;
  ByteReader chunk_;
  bool chunk_whole_ = true;
  std::uint64_t damaged_chunks_ = 0;
  std::uint64_t broken_off_at_ = 0;
  std::string break_reason_;
  bool unfinished_ = false;
};

}  // namespace glint::recording
