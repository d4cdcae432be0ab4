// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/simulator.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "driver/core/scan_assembler.hpp"

namespace glint::synth {
namespace {

struct Case {
  const char* world;
  LidarProfile profile;
  const char* optics;
};

SimulationOptions options_of(const Case& c) {
  SimulationOptions options;
  options.world = c.world;
  options.seconds = 0.3;
  options.seed = 11;
  options.sensor.profile = c.profile;
  options.sensor.optics = c.optics;
  options.sensor.beams = 32;
  return options;
}

class DecodedPoints : public testing::TestWithParam<Case> {};

// The whole way: cast, encode, decode, range to point, moved by the column's own pose.
TEST_P(DecodedPoints, LieOnTheSurfacesOfTheWorld) {
  SyntheticSource source(options_of(GetParam()));
  const Simulator& simulator = source.simulator();
  ScanAssembler assembler(simulator.info());
  const XyzLut lut(simulator.info());
  RawPacket packet;
  int scans = 0;
  double points = 0;
  double sum_m = 0;
  while (source.read(packet) == SourceStatus::kPacket) {
    ASSERT_EQ(assembler.push(packet.bytes), PacketError::kNone);
    while (const LidarScan* scan = assembler.next()) {
      ++scans;
      EXPECT_EQ(scan->completeness(), 1.0);
      EXPECT_EQ(scan->column_time.front(), source.truth().back().start);
      for (int m = 0; m < simulator.info().columns_per_frame; m += 7) {
        const Pose pose = simulator.true_pose(scan->column_time[static_cast<std::size_t>(m)]);
        for (int row = 0; row < simulator.info().pixels_per_column; ++row) {
          const std::uint32_t range_mm = scan->range_mm(row, m);
          if (range_mm == 0) continue;
          const Eigen::Vector3d p = pose * lut.point(row, m, range_mm);
          const double distance_m = simulator.scene().distance_to_surface_m(p);
          EXPECT_LT(distance_m, 0.25);  // six sigma of the faintest return
          sum_m += distance_m;
          ++points;
        }
      }
    }
  }
  EXPECT_EQ(scans, 3);
  EXPECT_GT(points, 8000);
  EXPECT_LT(sum_m / points, 0.015);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, DecodedPoints,
    testing::Values(Case{"corridor", LidarProfile::kLegacy, "os1"},
                    Case{"corridor", LidarProfile::kRng19Rfl8Sig16Nir16, "os0"},
                    Case{"room", LidarProfile::kRng19Rfl8Sig16Nir16Dual, "os1"},
                    Case{"room", LidarProfile::kRng15Rfl8Nir8, "os2"}),
    [](const auto& i) {
      return std::string(i.param.world) + "_" + std::string(to_string(i.param.profile));
    });

std::vector<std::byte> all_bytes(const SimulationOptions& options) {
  SyntheticSource source(options);
  std::vector<std::byte> bytes;
  RawPacket packet;
  while (source.read(packet) == SourceStatus::kPacket) {
    bytes.insert(bytes.end(), packet.bytes.begin(), packet.bytes.end());
  }
  return bytes;
}

TEST(Simulation, SameSeedGivesTheSameBytesWhateverTheThreads) {
  SimulationOptions options = options_of({"room", LidarProfile::kRng19Rfl8Sig16Nir16, "os1"});
  const auto one = all_bytes(options);
  // Backwards and on a thread each: the order of the work must not show.
  options.parallel_for = [](int count, const std::function<void(int)>& work) {
    std::vector<std::jthread> threads;
    for (int i = count - 1; i >= 0; --i) threads.emplace_back(work, i);
  };
  EXPECT_EQ(one, all_bytes(options));
  options.seed = 12;
  EXPECT_NE(one, all_bytes(options));
}

TEST(Simulation, OtherSeedsAreOtherPlaces) {
  const World a = make_world("room", 1);
  const World b = make_world("room", 2);
  const auto stands_in = [](const Surface& wanted, const World& world) {
    const auto& surfaces = world.scene.surfaces();
    return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& surface) {
      return bounds(surface.shape).isApprox(bounds(wanted.shape), 1e-3);
    });
  };
  const auto& surfaces = a.scene.surfaces();
  const auto common = std::count_if(surfaces.begin(), surfaces.end(),
                                    [&](const Surface& s) { return stands_in(s, b); });
  EXPECT_GT(surfaces.size(), 20U);
  EXPECT_LE(common, 6);  // walls, floor, ceiling
}

TEST(Simulation, TheCorridorsAxisIsBlindInItsMiddleAndARoomHasNone) {
  SimulationOptions options = options_of({"corridor", LidarProfile::kRng19Rfl8Sig16Nir16, "os1"});
  options.seconds = 30.0;
  options.sensor.beams = 16;
  options.sensor.columns = 512;
  Simulator corridor(options);
  LidarScan scan;
  ScanTruth truth;
  while (corridor.next(scan, truth)) {
  }
  ASSERT_EQ(truth.blind_axes.size(), 1U);
  EXPECT_GT(std::abs((truth.T_world_sensor.rotation * truth.blind_axes[0]).x()), 0.99);
  options.world = "room";
  options.seconds = 0.2;
  Simulator room(options);
  while (room.next(scan, truth)) EXPECT_TRUE(truth.blind_axes.empty());
}

TEST(Simulate, LeavesCaptureMetadataAndTruth) {
  const auto directory =
      std::filesystem::temp_directory_path() / ("glint-simulate-" + std::to_string(getpid()));
  simulate(options_of({"room", LidarProfile::kLegacy, "os1"}), directory);
  for (const char* name : {"capture.pcap", "metadata.json", "groundtruth.tum",
                           "groundtruth_100hz.tum", "truth.jsonl"}) {
    EXPECT_GT(std::filesystem::file_size(directory / name), 0U) << name;
  }
  const SensorInfo info = load_sensor_info(directory / "metadata.json");
  EXPECT_EQ(info.profile, LidarProfile::kLegacy);
  EXPECT_EQ(info.pixels_per_column, 32);
  std::ifstream lines(directory / "truth.jsonl");
  std::string line;
  int scans = 0;
  for (; std::getline(lines, line); ++scans) {
    const auto truth = nlohmann::json::parse(line);
    EXPECT_EQ(truth.at("frame_id"), scans + 1);
    EXPECT_TRUE(truth.at("blind_axes").empty());
  }
  EXPECT_EQ(scans, 3);
  std::filesystem::remove_all(directory);
}

TEST(Simulate, ADirectoryThatCannotBeMadeIsNamedAndNothingIsLeft) {
  try {
    simulate(options_of({"room", LidarProfile::kLegacy, "os1"}), "/proc/none/here");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/none/here"), std::string::npos);
  }
}

TEST(Simulate, AnUnknownWorldIsAnsweredWithTheKnownOnes) {
  SimulationOptions options;
  options.world = "moon";
  try {
    const Simulator simulator(options);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("corridor, room"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace glint::synth
