// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How a large map is loaded and served.
//
//   large_map make SESSION COPIES OUT      lays copies of a session side by side: one of many km
//   large_map load SESSION [MEMORY_MB]     loads it as a daemon does; times, memory, tiles served
//
// Copies have keypoints of their own (an eighth of each descriptor's bits are others), so that the
// words of one do not fit another.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "daemon/protocol_map.hpp"
#include "daemon/steady_clock.hpp"
#include "slam/backend.hpp"
#include "slam/loops/loops_by_appearance.hpp"
#include "slam/loops/place.hpp"
#include "slam/loops/vocabulary.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/session_store.hpp"

namespace glint {
namespace {

constexpr double kBeside_m = 150.0;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double resident_mb() {
  unsigned long total = 0;
  unsigned long resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu %lu", &total, &resident) != 2) resident = 0;
    static_cast<void>(std::fclose(file));
  }
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

void alter(slam::Features& features, std::mt19937_64& random) {
  for (slam::Descriptor& descriptor : features.descriptors) {
    for (std::uint64_t& word : descriptor) word ^= random() & random() & random();
  }
}

void make(const std::string& from, int copies, const std::string& to) {
  const slam::SessionReader source(from);
  slam::SessionStore store(to);
  for (const char* key : {"preset", "vocabulary_hash", "map_voxel_m", "moving_objects"}) {
    store.set_meta(key, source.meta(key));
  }
  const auto vocabulary = slam::default_vocabulary();
  std::mt19937_64 random(1);
  std::uint64_t id = 0;
  double way_m = 0.0;
  Pose last;
  for (int copy = 0; copy < copies; ++copy) {
    const Pose beside{Eigen::Quaterniond::Identity(), {0.0, kBeside_m * copy, 0.0}};
    bool first = true;
    source.for_each_keyframe([&](slam::SessionKeyframe&& stored) {
      stored.keyframe.id = id;
      stored.keyframe.estimate.sequence = 5 * id++;
      stored.keyframe.estimate.segment = static_cast<std::uint32_t>(copy);
      alter(stored.keyframe.features, random);
      if (!first) way_m += (stored.T_map_sensor.translation_m - last.translation_m).norm();
      first = false;
      last = stored.T_map_sensor;
      store.add(stored.keyframe, beside * stored.T_map_sensor,
                vocabulary->bag_of(slam::place_descriptors(stored.keyframe.features)));
      if (id % 100 == 0 && !store.commit()) throw std::runtime_error(std::string(store.error()));
    });
  }
  fmt::print("{} keyframes, {:.1f} km\n", id, 1e-3 * way_m);
}

void load(const std::string& file, int memory_mb) {
  slam::SlamConfig config;
  config.map_memory_mb = memory_mb;
  const double start_s = now_s();
  slam::Backend backend(config, {}, daemon::stage_clock(), slam::loops_by_appearance(config), file);
  fmt::print("ready to look for a place in {:.2f} s: {} keyframes, {:.0f} MB resident\n",
             now_s() - start_s, backend.snapshot()->keyframe_count, resident_mb());
  fmt::print("map {:.0f} MB in memory, {:.0f} MB on the disk\n",
             1e-6 * static_cast<double>(backend.memory().bytes),
             1e-6 * static_cast<double>(backend.memory().disk_bytes));
  const slam::SessionReader session(file, slam::SessionCheck::kVersion);
  slam::Keyframe scan = session.keyframe(session.keyframe_count() / 2)->keyframe;
  scan.id = 0;
  scan.estimate.segment = 0;
  const double asked_s = now_s();
  backend.process(scan);
  fmt::print("first look for a place: {:.1f} ms\n", 1e3 * (now_s() - asked_s));
  double longest_s = 0.0;
  bool whole = false;
  while (!whole) {
    const double begin_s = now_s();
    whole = !backend.restore_more();
    longest_s = std::max(longest_s, now_s() - begin_s);
  }
  fmt::print(
      "whole after {:.1f} s, {:.0f} ms at most at a time: {} points in {} tiles, {:.0f} MB\n",
      now_s() - start_s, 1e3 * longest_s, backend.snapshot()->point_count,
      backend.snapshot()->tiles.size(), resident_mb());

  std::vector<double> ms;
  for (const auto& tile : backend.snapshot()->tiles) {
    slam::MapSnapshot one;
    one.tiles = {tile};
    const double begin_s = now_s();
    const daemon::Json page = daemon::map_page({}, one);
    const std::string text = page.dump();
    ms.push_back(1e3 * (now_s() - begin_s));
  }
  std::ranges::sort(ms);
  if (ms.empty()) return;
  fmt::print("a tile of get_map: {:.2f} ms (median), {:.2f} ms (p99), {:.2f} ms (most)\n",
             ms[ms.size() / 2], ms[ms.size() * 99 / 100], ms.back());
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) try {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() == 4 && arguments[0] == "make") {
    glint::make(arguments[1], std::stoi(arguments[2]), arguments[3]);
  } else if (arguments.size() >= 2 && arguments[0] == "load") {
    glint::load(arguments[1], arguments.size() > 2 ? std::stoi(arguments[2]) : 0);
  } else {
    std::cerr << "large_map: say `make SESSION COPIES OUT` or `load SESSION [MEMORY_MB]`\n";
    return 2;
  }
} catch (const std::exception& error) {
  std::cerr << "large_map: " << error.what() << '\n';
  return 1;
}
