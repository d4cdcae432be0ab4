// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pcap/synth/motion/motion.hpp"
#include "pcap/synth/network_faults.hpp"
#include "pcap/synth/paint/photograph.hpp"
#include "pcap/synth/parallel.hpp"
#include "pcap/synth/sensor/imu_model.hpp"
#include "pcap/synth/sensor/sensor_options.hpp"

namespace glint::synth {

/// What a sensor does besides measuring.
struct StreamOptions {
  /// The first column that is sent: the first scan lacks those before.
  int first_column = 0;
  /// When the sensor restarts, s after the start; 0: never. It is silent for `restart_gap_s`, then
  /// goes on with another init id and frame ids from 0; its clock, set over the network, goes on.
  double restart_at_s = 0.0;
  double restart_gap_s = 2.0;
};

/// What to simulate. Everything follows from these values: the same options give the same bytes,
/// whatever `parallel_for` does; another seed gives another layout, walk, sensor and noise.
struct SimulationOptions {
  std::string world = "corridor";  ///< One of world_list().
  double seconds = 30.0;           ///< Rounded to whole scans, at least one.
  std::uint64_t seed = 1;
  MotionOptions motion{.kind = ""};  ///< No kind: the one that is usual in the world.
  std::filesystem::path trajectory;  ///< A TUM or KITTI file to follow instead.
  std::vector<Photograph> photographs;
  double traffic = 1.0;  ///< In the street: times as many moving cars and people, 0 to 10.
  SensorOptions sensor;
  NoiseOptions noise;
  ImuNoise imu;
  StreamOptions stream;
  NetworkFaults network;
  ParallelFor parallel_for = serial_for;
};

}  // namespace glint::synth
