// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/test_simulated_walk.hpp"

#include <Eigen/Core>

namespace glint::test {

bool next_whole(synth::Simulator& simulator, LidarScan& scan) {
  synth::ScanTruth truth;
  if (!simulator.next(scan, truth)) return false;
  const std::size_t columns = scan.column_time.size();
  scan.columns_expected = scan.columns_received = static_cast<int>(columns);
  scan.end_time = scan.column_time.back();
  scan.mid_time = scan.column_time[columns / 2];
  return true;
}

std::vector<ImuSample> measure_motion(const synth::Simulator& simulator, SensorTime from,
                                      SensorTime to) {
  constexpr std::int64_t kStep_ns = 10'000'000;
  constexpr double kStep_s = 0.01;
  const Eigen::Vector3d gravity_mps2(0.0, 0.0, -9.80665);
  std::vector<ImuSample> samples;
  for (SensorTime t = from; t <= to; t = t + kStep_ns) {
    const Pose before = simulator.true_pose(t + -kStep_ns);
    const Pose at = simulator.true_pose(t);
    const Pose after = simulator.true_pose(t + kStep_ns);
    const Eigen::Vector3d acceleration_mps2 =
        (after.translation_m - 2.0 * at.translation_m + before.translation_m) / (kStep_s * kStep_s);
    ImuSample sample;
    sample.accel_time = sample.gyro_time = t;
    sample.angular_rate_radps =
        so3_log(before.rotation.conjugate() * after.rotation) / (2.0 * kStep_s);
    sample.acceleration_mps2 = at.rotation.conjugate() * (acceleration_mps2 - gravity_mps2);
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace glint::test
