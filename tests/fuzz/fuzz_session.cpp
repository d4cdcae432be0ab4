// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Session files: a sound one with some of its bytes changed (first byte 0), or the parts of a
// keyframe as the file holds them (1 to 4).
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "driver/core/error.hpp"
#include "slam/store/compression.hpp"
#include "slam/store/feature_codec.hpp"
#include "slam/store/point_codec.hpp"
#include "slam/store/session_map.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/words_codec.hpp"
#include "tests/fuzz/byte_feed.hpp"
#include "tests/fuzz/require.hpp"

namespace {

namespace fs = std::filesystem;
namespace slam = glint::slam;
using glint::fuzz::ByteFeed;
using glint::fuzz::require;

slam::Keyframe keyframe_of(std::uint64_t id) {
  slam::Keyframe keyframe;
  keyframe.id = id;
  keyframe.estimate.stamp = {static_cast<std::int64_t>(id + 1) * 1'000'000'000};
  keyframe.estimate.covariance.setIdentity();
  keyframe.edge_covariance.setIdentity();
  for (int i = 0; i < 30; ++i) {
    const auto value = static_cast<float>(i);
    keyframe.points.push_back({value, 1.0F - value, 0.1F * value, value});
    if (i >= 4) continue;
    keyframe.features.keypoints.push_back({value, value, 0.1F * value, 0, 0.01F});
    keyframe.features.descriptors.push_back({id, 1, 2, 3});
    keyframe.features.points_m.emplace_back(i, 1, 2);
  }
  return keyframe;
}

/// A file of this process. SQLite asks what a link points to, so that one in /proc will not do.
fs::path scratch_file(const char* name) {
  return fs::temp_directory_path() / fmt::format("glint-fuzz-{}-{}.glint", name, ::getpid());
}

// Bytes of a session with all that one holds.
const std::vector<std::byte>& sound_session() {
  static const std::vector<std::byte> bytes = [] {
    const fs::path file = scratch_file("sound");
    {
      slam::SessionStore store(file);
      store.set_meta("preset", "full");
      for (std::uint64_t id = 0; id < 4; ++id) {
        store.add(keyframe_of(id), {}, slam::BagOfWords{{1, 0.5F}, {7, 0.5F}});
      }
      slam::LoopChanges changes;
      changes.added.push_back({0, 3, {}, Eigen::Matrix<double, 6, 6>::Identity()});
      store.apply(changes);
      require(store.commit(), "a session can be written");
    }
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto view = std::as_bytes(std::span(text));
    for (const char* companion : {"", "-wal", "-shm"}) fs::remove(file.string() + companion);
    return std::vector<std::byte>(view.begin(), view.end());
  }();
  return bytes;
}

// All that a load, an export and a merge ask for.
void read_all(const fs::path& file) {
  const slam::SessionReader session(file);
  static_cast<void>(session.meta("preset"));
  static_cast<void>(session.sensors());
  static_cast<void>(session.poses());
  static_cast<void>(session.segments());
  static_cast<void>(session.odometry_edges());
  static_cast<void>(session.loop_edges());
  static_cast<void>(session.events());
  session.for_each_outline([](slam::KeyframeOutline&&) {});
  session.for_each_keyframe([](slam::SessionKeyframe&& stored) {
    const slam::Features& features = stored.keyframe.features;
    require(features.descriptors.size() == features.size(), "each keypoint has a descriptor");
    require(features.points_m.size() == features.size(), "each keypoint has a point");
    require(stored.T_map_sensor.translation_m.allFinite(), "poses are finite");
  });
  static_cast<void>(slam::session_map(session));
}

void change_and_read(ByteFeed feed) {
  std::vector<std::byte> bytes = sound_session();
  while (!feed.empty()) {
    const std::size_t page = feed.byte();
    const std::size_t at = page * 4096 + feed.word() % 4096;
    const auto change = feed.bytes(1 + feed.byte() % 8U);
    if (at >= bytes.size()) continue;
    const std::size_t size = std::min(change.size(), bytes.size() - at);
    std::copy_n(change.begin(), size, bytes.begin() + static_cast<std::ptrdiff_t>(at));
  }
  static const fs::path file = scratch_file("changed");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  try {
    read_all(file);
  } catch (const glint::InputError& error) {
    // The verdict that most changes deserve; without one it would be wrong.
    require(bytes != sound_session(), error.what());
  }
  fs::remove(file);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteFeed feed(glint::fuzz::as_bytes(data, size));
  const unsigned part = feed.byte() % 5U;
  const auto rest = feed.bytes(size);
  switch (part) {
    case 0:
      change_and_read(ByteFeed(rest));
      break;
    case 1:
      if (const auto points = slam::decode_points(slam::compress(rest))) {
        require(std::ranges::all_of(*points,
                                    [](const slam::MapPoint& p) {
                                      return std::isfinite(p.x_m) && std::isfinite(p.y_m) &&
                                             std::isfinite(p.z_m);
                                    }),
                "points are finite");
      }
      break;
    case 2:
      static_cast<void>(slam::decode_features(slam::compress(rest)));
      break;
    case 3:
      static_cast<void>(slam::decode_words(rest));
      break;
    default:
      static_cast<void>(slam::decode_points(rest));
  }
  return 0;
}
