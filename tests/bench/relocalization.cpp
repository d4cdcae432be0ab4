// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Relocalisation without a guess against the truth of simulated worlds: a sensor that wakes up at
// one place after the other of a second walk is looked for in the map of a first one.
//
//   relocalization [--seconds S] [--every S] [--follow] MAP QUERIES...
//   relocalization building,seed=2,seconds=200 building,seed=2,seconds=60,trajectory=other.tum
//
// Each simulation is WORLD[,name=value...]. The sensor wakes up each `every` seconds (default 4)
// and has `seconds` (default 2) to be found. Where it is within 3 m (6 m in the open) of the first
// walk it should be; it is found wrongly when it is off by more than 0.3 m or 3 degrees, or
// elsewhere. With --follow it wakes up once and is followed in the map, which is only read, until
// the end: errors are those of each scan's pose in the map from where it was found on, beside those
// of odometry alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "pcap/synth/option_keys.hpp"
#include "pcap/synth/simulator.hpp"
#include "slam/frontend.hpp"
#include "slam/loops/relocalizer.hpp"
#include "slam/map_localizer.hpp"

namespace glint {
namespace {

constexpr double kFalse_m = 0.3;
constexpr double kFalse_rad = 3.0 * M_PI / 180.0;

double near_m(const std::string& world) {
  for (const char* open : {"street", "parking", "hill", "campus"}) {
    if (world == open) return 6.0;
  }
  return 3.0;
}

double thread_cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

// The map frame is the world: what the map itself errs by is another's business.
std::vector<Pose> make_map(const std::string& text, slam::Relocalizer& relocalizer) {
  synth::Simulator simulator(synth::parse_simulation(text, {}));
  slam::Frontend frontend(simulator.info(), {});
  std::vector<Pose> poses;
  LidarScan scan;
  synth::ScanTruth truth;
  while (simulator.next(scan, truth)) {
    frontend.process(scan);
    const auto keyframe = frontend.take_keyframe();
    if (!keyframe) continue;
    poses.push_back(simulator.true_pose(scan.end_time));
    relocalizer.remember(*keyframe, poses.back());
  }
  return poses;
}

struct Figures {
  int wakes = 0;  ///< Within reach of the map.
  int found = 0;
  int elsewhere = 0;  ///< Beyond its reach.
  int wrong = 0;
  double worst_m = 0.0;
  std::vector<double> took_s;
  std::vector<double> cpu_ms;
};

void wake(synth::Simulator& simulator, int scans, const std::vector<Pose>& map, double near,
          slam::Relocalizer& relocalizer, Figures& figures) {
  slam::Frontend frontend(simulator.info(), {});
  frontend.set_searching(true);
  relocalizer.begin_anew();
  LidarScan scan;
  synth::ScanTruth truth;
  bool found = false;
  bool reachable = false;
  SensorTime begin;
  for (int i = 0; i < scans && simulator.next(scan, truth); ++i) {
    if (i == 0) begin = scan.end_time;
    const Pose T_world_sensor = simulator.true_pose(scan.end_time);
    reachable = reachable || std::ranges::any_of(map, [&](const Pose& pose) {
                  return (pose.translation_m - T_world_sensor.translation_m).norm() < near;
                });
    if (found) continue;
    frontend.process(scan);
    const auto keyframe = frontend.take_keyframe();
    if (!keyframe) continue;
    const double start_ms = thread_cpu_ms();
    const auto relocation = relocalizer.locate(*keyframe);
    figures.cpu_ms.push_back(thread_cpu_ms() - start_ms);
    if (!relocation) continue;
    found = true;
    const Pose error = T_world_sensor.inverse() * relocation->T_map_sensor;
    const double off_m = error.translation_m.norm();
    figures.worst_m = std::max(figures.worst_m, off_m);
    figures.took_s.push_back(static_cast<double>(scan.end_time - begin) * kSecondsPerNs);
    if (off_m > kFalse_m || so3_log(error.rotation).norm() > kFalse_rad) {
      ++figures.wrong;
      fmt::print("  wrong by {:.2f} m, {:.1f} degrees at {:.1f} s\n", off_m,
                 so3_log(error.rotation).norm() * 180.0 / M_PI,
                 static_cast<double>(scan.end_time.ns) * kSecondsPerNs);
    }
  }
  ++(reachable ? figures.wakes : figures.elsewhere);
  if (reachable && found) ++figures.found;
}

double median(std::vector<double> values, double share = 0.5) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void look(const std::string& text, double seconds, double every, const std::vector<Pose>& map,
          slam::Relocalizer& relocalizer) {
  const synth::SimulationOptions options = synth::parse_simulation(text, {});
  synth::Simulator simulator(options);
  const double rate_hz = simulator.info().scan_rate_hz;
  const int scans = static_cast<int>(seconds * rate_hz) + 1;
  const int between = std::max(scans, static_cast<int>(every * rate_hz));
  const int total = static_cast<int>(options.seconds * rate_hz);
  Figures figures;
  LidarScan scan;
  synth::ScanTruth truth;
  for (int at = 0; at + scans <= total; at += between) {
    wake(simulator, scans, map, near_m(options.world), relocalizer, figures);
    for (int i = scans; i < between; ++i) simulator.next(scan, truth);
  }
  fmt::print(
      "{}: found {} of {}, {} elsewhere, {} wrong, worst {:.3f} m; after {:.1f} s "
      "(median), {:.1f} s (most); {:.1f} ms a look, at most {:.1f}\n",
      text, figures.found, figures.wakes, figures.elsewhere, figures.wrong, figures.worst_m,
      median(figures.took_s), median(figures.took_s, 1.0), median(figures.cpu_ms),
      median(figures.cpu_ms, 1.0));
}

// Root mean square and largest distance from the truth.
struct Errors {
  void add(const Pose& truth, const Pose& pose) {
    const double off_m = (truth.translation_m - pose.translation_m).norm();
    squares_m2 += off_m * off_m;
    most_m = std::max(most_m, off_m);
    ++count;
  }
  [[nodiscard]] double rms_m() const { return std::sqrt(squares_m2 / std::max(1, count)); }

  double squares_m2 = 0.0;
  double most_m = 0.0;
  int count = 0;
};

void follow(const std::string& text, const slam::Relocalizer& map) {
  synth::Simulator simulator(synth::parse_simulation(text, {}));
  slam::Frontend frontend(simulator.info(), {});
  slam::MapLocalizer localizer(map);
  slam::MapCorrection correction;
  correction.placed = false;
  std::optional<Pose> T_world_odom;
  Errors followed;
  Errors odometry;
  Errors anchored;
  double sigmas_m2 = 0.0;
  int misfits = 0;
  int keyframes = 0;
  int scans = 0;
  std::vector<double> cpu_ms;
  LidarScan scan;
  synth::ScanTruth truth;
  while (simulator.next(scan, truth)) {
    ++scans;
    frontend.set_searching(!correction.placed);
    const slam::OdometryEstimate estimate = frontend.process(scan);
    const Pose T_world_sensor = simulator.true_pose(scan.end_time);
    if (correction.placed) {
      followed.add(T_world_sensor, correction.T_map_odom * estimate.T_odom_sensor);
      odometry.add(T_world_sensor, *T_world_odom * estimate.T_odom_sensor);
    }
    const auto keyframe = frontend.take_keyframe();
    if (!keyframe) continue;
    const double start_ms = thread_cpu_ms();
    localizer.process(*keyframe, correction);
    if (!correction.placed) continue;
    cpu_ms.push_back(thread_cpu_ms() - start_ms);
    if (!T_world_odom) T_world_odom = T_world_sensor * estimate.T_odom_sensor.inverse();
    ++keyframes;
    misfits += correction.confidence < 1.0 ? 1 : 0;
    anchored.add(T_world_sensor, correction.T_map_odom * estimate.T_odom_sensor);
    sigmas_m2 += correction.certainty->covariance.diagonal().head<3>().sum();
  }
  fmt::print(
      "{}: {} of {} scans in the map, off by {:.3f} m rms, {:.3f} at most (odometry from the first "
      "one on {:.3f} and {:.3f}); {} keyframes, {} do not fit, {:.3f} m rms where the covariance "
      "says {:.3f}; {:.1f} ms a keyframe, at most {:.1f}; epoch {}\n",
      text, followed.count, scans, followed.rms_m(), followed.most_m, odometry.rms_m(),
      odometry.most_m, keyframes, misfits, anchored.rms_m(),
      std::sqrt(sigmas_m2 / std::max(1, keyframes)), median(cpu_ms), median(cpu_ms, 1.0),
      correction.epoch);
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) try {
  double seconds = 2.0;
  double every = 4.0;
  bool follows = false;
  std::vector<std::string> simulations;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--seconds" && i + 1 < argc) {
      seconds = std::stod(argv[++i]);
    } else if (argument == "--every" && i + 1 < argc) {
      every = std::stod(argv[++i]);
    } else if (argument == "--follow") {
      follows = true;
    } else {
      simulations.push_back(argument);
    }
  }
  glint::slam::Relocalizer relocalizer(glint::slam::default_vocabulary());
  std::vector<glint::Pose> map;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    if (i == 0) {
      map = glint::make_map(simulations[0], relocalizer);
      fmt::print("{}: {} keyframes\n", simulations[0], map.size());
    } else if (follows) {
      glint::follow(simulations[i], relocalizer);
    } else {
      glint::look(simulations[i], seconds, every, map, relocalizer);
    }
  }
} catch (const std::exception& error) {
  std::cerr << "relocalization: " << error.what() << '\n';
  return 1;
}
