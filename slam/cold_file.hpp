// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>

namespace glint::slam {

/// Room on the disk for what a map seldom asks for. What is put there is read as memory is: the
/// kernel brings it in when somebody looks at it, and takes its room when others need it. The file
/// has no name and goes with the process. Thread-safe.
class ColdFile : public std::enable_shared_from_this<ColdFile> {
 public:
  /// Null where there can be none in that directory.
  static std::shared_ptr<ColdFile> create(const std::filesystem::path& directory);
  ~ColdFile();
  ColdFile(const ColdFile&) = delete;
  ColdFile& operator=(const ColdFile&) = delete;

  /// Puts the parts there one after the other. What comes back may be read by any thread; its room
  /// in the file is used anew when its last owner lets it go. Null where the disk takes no more.
  std::shared_ptr<const std::byte> put(std::span<const std::byte> first,
                                       std::span<const std::byte> second = {});
  /// Gives back the memory of all that was looked at; it comes again when it is asked for.
  void rest() const;
  /// Now in use on the disk.
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  ColdFile(int file, std::byte* memory) : file_(file), memory_(memory) {}

  std::uint64_t take_room(std::uint64_t bytes);
  void give_back(std::uint64_t begin, std::uint64_t bytes);
  [[nodiscard]] bool write(std::span<const std::byte> bytes, std::uint64_t at) const;

  const int file_;
  std::byte* const memory_;
  mutable std::mutex mutex_;                     ///< Of what follows.
  std::map<std::uint64_t, std::uint64_t> free_;  ///< Before end_: begin and bytes, none adjoining.
  std::uint64_t end_ = 0;
  std::uint64_t used_ = 0;
};

}  // namespace glint::slam
