// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

namespace glint::slam::test {

/// A disk whose power can be cut: SQLite's default while it lives. Programs see what they write at
/// once, but only what was synchronised is sure to be there after the cut; of all else each write
/// may have come about or not, in any order, and the last of them in part. One at a time.
class PowerCutDisk {
 public:
  explicit PowerCutDisk(std::uint32_t seed);
  ~PowerCutDisk();
  PowerCutDisk(const PowerCutDisk&) = delete;
  PowerCutDisk& operator=(const PowerCutDisk&) = delete;

  /// From now on, this many writes, truncations and synchronisations are done, and no more.
  void cut_after(int operations);
  [[nodiscard]] bool is_off() const;
  /// Puts what the disk holds after the cut of `file` and of its log into `directory`.
  void leave(const std::filesystem::path& file, const std::filesystem::path& directory);

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace glint::slam::test
