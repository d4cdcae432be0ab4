// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "pcap/capture_writer.hpp"

namespace glint::daemon {

struct CapturePartsOptions {
  std::filesystem::path file;         ///< F.pcap; parts are F_0001.pcap, F_0002.pcap, ...
  std::uint64_t part_bytes = 0;       ///< A part ends when it has so many; 0: no parts.
  std::uint64_t max_total_bytes = 0;  ///< Oldest parts are deleted to stay below; 0: never.
};

/// A recording: one capture or a row of them, each with the sensor's metadata beside it, so that
/// each can be replayed. Captures are written in place: whatever ends the process or the machine,
/// what was flushed or synced is readable. Thread-compatible.
class CaptureParts {
 public:
  /// Begins the first file. @throws InputError when it is there already or cannot be written.
  CaptureParts(CapturePartsOptions options, std::string metadata_json);

  /// @throws InputError when it cannot be written, e.g. because the disk is full.
  void write(HostTime host_time, const Endpoint& source, const Endpoint& destination,
             std::span<const std::byte> payload);
  /// Has everything in the kernel's hands by now. @throws InputError.
  void flush() { writer_->flush(); }
  /// Has everything on the disk by now. @throws InputError.
  void sync() { writer_->sync(); }
  /// @throws InputError.
  void finish() { writer_->finish(); }
  /// The metadata of files that begin from now on; with parts, the next begins at once.
  void set_metadata(std::string metadata_json);

  [[nodiscard]] std::uint64_t files() const { return files_; }
  [[nodiscard]] std::uint64_t deleted_files() const { return deleted_files_; }
  /// Of all captures there are.
  [[nodiscard]] std::uint64_t bytes() const { return closed_bytes_ + writer_->bytes(); }
  [[nodiscard]] const std::filesystem::path& current_file() const { return current_; }

 private:
  struct Closed {
    std::filesystem::path file;
    std::uint64_t bytes = 0;
  };
  void begin_file();
  void begin_next_part();
  void delete_oldest();

  const CapturePartsOptions options_;
  std::string metadata_json_;
  std::filesystem::path current_;
  std::optional<CaptureWriter> writer_;
  std::deque<Closed> closed_;  ///< Oldest first.
  std::uint64_t closed_bytes_ = 0;
  std::uint64_t files_ = 0;
  std::uint64_t deleted_files_ = 0;
};

}  // namespace glint::daemon
