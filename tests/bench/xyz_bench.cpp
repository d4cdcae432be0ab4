// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Destaggered points of a 64x1024 scan: in one pass, and as points first that are then destaggered.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "driver/core/destagger.hpp"
#include "driver/core/test_sensor.hpp"
#include "driver/core/xyz_lut.hpp"

namespace glint {
namespace {

struct Scene {
  SensorInfo info = test::make_sensor(LidarProfile::kLegacy, 64, 1024);
  XyzLut lut{info};
  std::mt19937 random{1};
  Image<std::uint32_t> range_mm = test::random_scan(info, 0, random).range_mm;
  std::vector<Eigen::Vector3d> points{range_mm.data.size()};
};

void one_pass(benchmark::State& state) {
  Scene scene;
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    scene.lut.destaggered_points(scene.range_mm, scene.info.pixel_shift_by_row, scene.points);
    benchmark::DoNotOptimize(scene.points.data());
    benchmark::ClobberMemory();
  }
}

void two_passes(benchmark::State& state) {
  Scene scene;
  std::vector<Eigen::Vector3d> staggered(scene.points.size());
  const int columns = scene.range_mm.cols;
  for ([[maybe_unused]] auto _ :
       state) {  // NOLINT: the library's idiom, its variable is never read
    for (int r = 0; r < scene.range_mm.rows; ++r) {
      for (int m = 0; m < columns; ++m) {
        staggered[scene.range_mm.index(r, m)] = scene.lut.point(r, m, scene.range_mm(r, m));
      }
    }
    for (int r = 0; r < scene.range_mm.rows; ++r) {
      const int shift = scene.info.pixel_shift_by_row[static_cast<std::size_t>(r)];
      const Eigen::Vector3d* row = &staggered[scene.range_mm.index(r, 0)];
      std::rotate_copy(row, row + staggered_column(0, shift, columns), row + columns,
                       &scene.points[scene.range_mm.index(r, 0)]);
    }
    benchmark::DoNotOptimize(scene.points.data());
    benchmark::ClobberMemory();
  }
}

BENCHMARK(one_pass)->Unit(benchmark::kMicrosecond);
BENCHMARK(two_passes)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace glint

BENCHMARK_MAIN();
