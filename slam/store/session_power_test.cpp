// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
// The session file after the power was cut.
#include <gtest/gtest.h>

#include <random>

#include "slam/store/power_cut_vfs.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

class SessionPower : public test::InDirectory {
 protected:
  SessionPower() {
    for (std::uint64_t id = 0; id < 300; ++id) {
      keyframes_.push_back(test::sample_keyframe(id, 500, 500));
    }
  }

  // Writes until the power goes; returns how many keyframes were told to be on the disk.
  std::size_t write(test::PowerCutDisk& disk, std::mt19937& random) const {
    SessionStore store(file_);
    // Late ones come after the log was taken into the database once or twice.
    disk.cut_after(static_cast<int>(1 + random() % (random() % 2 == 0 ? 300 : 8000)));
    std::size_t sure = 0;
    for (std::size_t id = 0; id < keyframes_.size() && !disk.is_off(); ++id) {
      store.add(keyframes_[id], {});
      if (id % 7 == 6) store.apply({{}, {test::sample_loop(id - 5, id)}, {}, {{id - 3, {}}}});
      if (random() % 2 == 0 && store.commit()) sure = id + 1;
    }
    disk.cut_after(0);
    return sure;
  }

  // Keyframes in a session that must be whole.
  [[nodiscard]] std::size_t sound_keyframes(const std::filesystem::path& file) const {
    const SessionReader session(file);
    std::size_t count = 0;
    session.for_each_keyframe([&](SessionKeyframe&& read) {
      EXPECT_EQ(read.keyframe.id, count) << "one is missing";
      EXPECT_EQ(read.keyframe.features.descriptors, keyframes_[count].features.descriptors);
      ++count;
    });
    EXPECT_EQ(session.odometry_edges().size(), count > 0 ? count - 1 : 0);
    return count;
  }

  std::vector<Keyframe> keyframes_;
};

TEST_F(SessionPower, WhatWasCommittedOutlivesACutAtAnyMoment) {
  std::size_t most = 0;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    const auto after = directory_ / ("after" + std::to_string(seed));
    std::filesystem::create_directory(after);
    std::mt19937 random(seed);
    std::size_t sure = 0;
    {
      test::PowerCutDisk disk(seed);
      sure = write(disk, random);
      disk.leave(file_, after);
    }
    const auto left = after / file_.filename();
    const std::size_t kept = sound_keyframes(left);
    EXPECT_GE(kept, sure);
    most = std::max(most, kept);
    // And the next start goes on with it.
    Keyframe next = keyframes_[0];
    next.id = kept;
    { SessionStore(left, {.continues = true}).add(next, {}); }
    EXPECT_EQ(SessionReader(left).keyframe_count(), kept + 1);
    std::filesystem::remove_all(after);
  }
  EXPECT_GT(most, 50U) << "no cut came late enough";
}

}  // namespace
}  // namespace glint::slam
