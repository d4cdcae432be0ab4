// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "driver/core/sensor_info.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"

namespace glint::slam::test {

/// A keyframe with something in all that a session keeps; drawn from its id.
Keyframe sample_keyframe(std::uint64_t id, std::size_t points = 200, std::size_t keypoints = 20);
/// Where sample_keyframe(id) is in the map.
Pose sample_map_pose(std::uint64_t id);
LoopEdge sample_loop(std::uint64_t from, std::uint64_t to);
SensorInfo sample_sensor();

/// The first column of the first row that a query gives, as another program would read it.
std::string query(const std::filesystem::path& file, const std::string& sql);

std::string read_bytes(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);
/// What the call throws as InputError; empty when it throws none.
template <class Call>
std::string refusal_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// A test with a directory of its own.
class InDirectory : public testing::Test {
 protected:
  InDirectory();
  ~InDirectory() override;

  /// Names of what lies in the directory, in order, with a blank after each.
  [[nodiscard]] std::string files() const;

  const std::filesystem::path directory_;
  const std::filesystem::path file_ = directory_ / "session.glint";
};

}  // namespace glint::slam::test
