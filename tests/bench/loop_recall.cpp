// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Loop detection against the truth of simulated worlds: how many of the places seen again are
// found, and whether what is found is true.
//
//   loop_recall [--paper] [--drift] [--no-density] [--bare] WORLD[,name=value...]...
//   loop_recall --drift building,seed=11,seconds=240 street,seconds=130,motion=vehicle,speed=6
//
// A keyframe sees a place again when an older one lies within 3 m (6 m in the open), more than 30 s
// and 10 m of way before. Five seconds of such keyframes are one place; it is found when one of
// them gets a loop. A loop is false when it is off by more than 0.3 m or 2 degrees. With --drift
// odometry errs by 10 m and 20 degrees shortly before the first place is seen again; with
// --no-density places are not proposed by their shape; with --bare keyframes have no keypoints.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include "pcap/synth/option_keys.hpp"
#include "pcap/synth/simulator.hpp"
#include "slam/frontend.hpp"
#include "slam/loops/loop_detector.hpp"

namespace glint {
namespace {

constexpr double kGap_s = 30.0;
constexpr double kGap_m = 10.0;
constexpr double kPlace_s = 5.0;
constexpr double kFalse_m = 0.3;
constexpr double kFalse_rad = 2.0 * M_PI / 180.0;
constexpr std::size_t kDriftBefore = 15;  // Keyframes.

struct Seen {
  slam::Keyframe keyframe;
  Pose truth;
  double time_s = 0.0;
  double path_m = 0.0;
};

double near_m(const std::string& world) {
  for (const char* open : {"street", "parking", "hill", "campus"}) {
    if (world == open) return 6.0;
  }
  return 3.0;
}

std::vector<Seen> walk(const synth::SimulationOptions& options, const slam::SlamConfig& config) {
  synth::Simulator simulator(options);
  slam::Frontend frontend(simulator.info(), config);
  std::vector<Seen> all;
  LidarScan scan;
  synth::ScanTruth truth;
  while (simulator.next(scan, truth)) {
    frontend.process(scan);
    auto keyframe = frontend.take_keyframe();
    if (!keyframe) continue;
    Seen seen{std::move(*keyframe), simulator.true_pose(scan.end_time), 0.0, 0.0};
    seen.time_s = static_cast<double>(seen.keyframe.estimate.stamp.ns) * kSecondsPerNs;
    if (!all.empty()) {
      seen.path_m =
          all.back().path_m + (seen.truth.translation_m - all.back().truth.translation_m).norm();
    }
    all.push_back(std::move(seen));
  }
  return all;
}

bool seen_again(const std::vector<Seen>& all, std::size_t i, double near) {
  return std::any_of(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i), [&](const Seen& older) {
        return all[i].time_s - older.time_s > kGap_s && all[i].path_m - older.path_m > kGap_m &&
               (all[i].truth.translation_m - older.truth.translation_m).norm() < near;
      });
}

void add_drift(std::vector<Seen>& all, double near) {
  std::size_t first = 0;
  while (first < all.size() && !seen_again(all, first, near)) ++first;
  if (first == all.size()) return;
  const Pose here = all[first].keyframe.estimate.T_odom_sensor;
  Pose off;
  off.rotation = so3_exp({0.0, 0.0, 20.0 * M_PI / 180.0}) * here.rotation;
  off.translation_m = here.translation_m + Eigen::Vector3d(8.0, -6.0, 0.0);
  const Pose drift = off * here.inverse();
  for (std::size_t i = first - std::min(first, kDriftBefore); i < all.size(); ++i) {
    Pose& pose = all[i].keyframe.estimate.T_odom_sensor;
    pose = drift * pose;
  }
}

struct Figures {
  int loops = 0;
  int false_loops = 0;
  int places = 0;
  int found = 0;
  double worst_m = 0.0;
  std::vector<double> cpu_ms;
};

double thread_cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

bool is_false(const slam::LoopEdge& edge, const std::vector<Seen>& all, double& off_m) {
  const Pose truth = all[edge.from].truth.inverse() * all[edge.to].truth;
  const Pose error = truth.inverse() * edge.T_from_to;
  off_m = error.translation_m.norm();
  return off_m > kFalse_m || so3_log(error.rotation).norm() > kFalse_rad;
}

Figures detect(const std::vector<Seen>& all, double near, bool density) {
  Figures figures;
  slam::LoopDetector detector(slam::default_vocabulary(), density);
  std::vector<bool> closed(all.size());
  for (const Seen& seen : all) {
    const double start_ms = thread_cpu_ms();
    const std::vector<slam::LoopEdge> edges = detector.add(seen.keyframe);
    figures.cpu_ms.push_back(thread_cpu_ms() - start_ms);
    for (const slam::LoopEdge& edge : edges) {
      double off_m = 0.0;
      ++figures.loops;
      figures.false_loops += is_false(edge, all, off_m) ? 1 : 0;
      figures.worst_m = std::max(figures.worst_m, off_m);
      closed[edge.to] = true;
    }
  }
  double place_from_s = -kPlace_s;
  bool place_found = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!seen_again(all, i, near)) continue;
    if (all[i].time_s - place_from_s > kPlace_s) {
      ++figures.places;
      place_from_s = all[i].time_s;
      place_found = false;
    }
    if (closed[i] && !place_found) ++figures.found;
    place_found = place_found || closed[i];
  }
  return figures;
}

struct Ways {
  bool drift = false;
  bool bare = false;
};

void run(const std::string& text, const slam::SlamConfig& config, const Ways& ways) {
  const synth::SimulationOptions options = synth::parse_simulation(text, {});
  const double near = near_m(options.world);
  std::vector<Seen> all = walk(options, config);
  if (ways.drift) add_drift(all, near);
  if (ways.bare) {
    for (Seen& seen : all) seen.keyframe.features.clear();
  }
  Figures figures = detect(all, near, config.loop_density);
  std::ranges::sort(figures.cpu_ms);
  double total_ms = 0.0;
  for (const double ms : figures.cpu_ms) total_ms += ms;
  const auto count = std::max<std::size_t>(1, figures.cpu_ms.size());
  std::cout << fmt::format(
                   "{}: {} keyframes, {:.0f} m; {} of {} places found, {} loops, {} false, off by "
                   "{:.3f} m at "
                   "most; {:.1f} ms a keyframe, p99 {:.1f}, at most {:.1f}\n",
                   text, all.size(), all.empty() ? 0.0 : all.back().path_m, figures.found,
                   figures.places, figures.loops, figures.false_loops, figures.worst_m,
                   total_ms / static_cast<double>(count),
                   figures.cpu_ms.empty() ? 0.0 : figures.cpu_ms[count * 99 / 100],
                   figures.cpu_ms.empty() ? 0.0 : figures.cpu_ms.back())
            << std::flush;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) try {
  glint::slam::SlamConfig config;
  glint::Ways ways;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--paper") {
      config = glint::slam::preset_config("paper");
    } else if (argument == "--drift") {
      ways.drift = true;
    } else if (argument == "--bare") {
      ways.bare = true;
    } else if (argument == "--no-density") {
      config.loop_density = false;
    } else {
      glint::run(argument, config, ways);
    }
  }
} catch (const std::exception& error) {
  std::cerr << "loop_recall: " << error.what() << '\n';
  return 1;
}
