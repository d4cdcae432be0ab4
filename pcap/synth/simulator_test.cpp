// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/simulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <thread>

#include "driver/core/scan_assembler.hpp"
#include "pcap/synth/synthetic_source.hpp"

namespace glint::synth {
namespace {

struct Case {
  const char* world;
  const char* motion;
  LidarProfile profile;
  const char* optics;
  int beams;
  int columns;
  int rate_hz;
};

SimulationOptions options_of(const Case& c) {
  SimulationOptions options;
  options.world = c.world;
  options.motion.kind = c.motion;
  options.motion.rest_s = 0.0;
  options.seed = 11;
  options.sensor.profile = c.profile;
  options.sensor.optics = c.optics;
  options.sensor.beams = c.beams;
  options.sensor.columns = c.columns;
  options.sensor.rate_hz = c.rate_hz;
  options.seconds = 3.0 / c.rate_hz;
  return options;
}

SimulationOptions small_room() {
  return options_of({"room", "walking", LidarProfile::kRng19Rfl8Sig16Nir16, "os1", 32, 512, 10});
}

// Where the points of decoded scans really are.
class PointErrors {
 public:
  explicit PointErrors(const Simulator& simulator)
      : simulator_(simulator), lut_(simulator.info()) {}

  void add(const LidarScan& scan) {
    for (int m = 0; m < simulator_.info().columns_per_frame; m += 5) {
      const double t_s = simulator_.timing().true_s(scan.column_time[static_cast<std::size_t>(m)]);
      const Pose pose = simulator_.motion()(t_s);
      const Scene::Moment moment = simulator_.scene().at(t_s);
      for (int row = 0; row < simulator_.info().pixels_per_column; ++row) {
        const std::uint32_t range_mm = scan.range_mm(row, m);
        if (range_mm == 0) continue;
        const Eigen::Vector3d origin_m = pose * lut_.offset(row, m);
        const Eigen::Vector3d point_m = pose * lut_.point(row, m, range_mm);
        const Eigen::Vector3d way = point_m - origin_m;
        const Sighting seen = moment.cast({origin_m, way.normalized()});
        ASSERT_NE(seen.surface, nullptr);
        errors_m_.push_back(way.norm() - seen.hit.distance_m);
        if (errors_m_.size() % 97 == 0) {
          farthest_m_ = std::max(farthest_m_, moment.distance_to_surface_m(point_m));
        }
      }
    }
  }
  [[nodiscard]] std::size_t count() const { return errors_m_.size(); }
  [[nodiscard]] double mean_m() const {
    return std::accumulate(errors_m_.begin(), errors_m_.end(), 0.0) /
           static_cast<double>(errors_m_.size());
  }
  [[nodiscard]] double deviation_m() const {
    return std::sqrt(
        std::inner_product(errors_m_.begin(), errors_m_.end(), errors_m_.begin(), 0.0) /
        static_cast<double>(errors_m_.size()));
  }
  /// Of every so manieth point, from any surface.
  [[nodiscard]] double farthest_m() const { return farthest_m_; }

 private:
  const Simulator& simulator_;
  const XyzLut lut_;
  std::vector<double> errors_m_;
  double farthest_m_ = 0.0;
};

class DecodedPoints : public testing::TestWithParam<Case> {};

// The whole way: cast, encode, decode, range to point, moved by the column's own pose.
TEST_P(DecodedPoints, LieOnTheSurfacesOfTheWorldWithinTheNoise) {
  SimulationOptions options = options_of(GetParam());
  options.noise.mixed_pixels = false;  // Those lie between surfaces.
  options.noise.one_photon_sigma_m = 0.0;
  SyntheticSource source(options);
  const Simulator& simulator = source.simulator();
  ScanAssembler assembler(simulator.info());
  PointErrors errors(simulator);
  RawPacket packet;
  int scans = 0;
  while (source.read(packet) == SourceStatus::kPacket) {
    if (packet.port != simulator.info().lidar_port) continue;
    ASSERT_EQ(assembler.push(packet.bytes), PacketVerdict::kLidar);
    while (const LidarScan* scan = assembler.next()) {
      ++scans;
      EXPECT_EQ(scan->completeness(), 1.0);
      EXPECT_EQ(scan->column_time.front(), source.truth().start);
      ASSERT_NO_FATAL_FAILURE(errors.add(*scan));
    }
  }
  EXPECT_EQ(scans, 3);
  ASSERT_GT(errors.count(), 1500U);
  EXPECT_LT(std::abs(errors.mean_m()), 0.001);
  const double step_m =
      0.001 * profile_layout(simulator.info().profile).field(Channel::kRange).scale;
  const NoiseOptions& noise = options.noise;
  const double expected_m =
      std::hypot(noise.range_sigma_m, noise.beam_bias_m, step_m / std::sqrt(12.0));
  EXPECT_NEAR(errors.deviation_m(), expected_m, 0.06 * expected_m);
  EXPECT_LT(errors.farthest_m(), 5.0 * expected_m);
}

constexpr auto kLegacy = LidarProfile::kLegacy;
constexpr auto kSingle = LidarProfile::kRng19Rfl8Sig16Nir16;
constexpr auto kDual = LidarProfile::kRng19Rfl8Sig16Nir16Dual;
constexpr auto kLowRate = LidarProfile::kRng15Rfl8Nir8;

INSTANTIATE_TEST_SUITE_P(
    Cases, DecodedPoints,
    testing::Values(Case{"corridor", "walking", kLegacy, "os1", 64, 512, 10},
                    Case{"building", "wheeled", kSingle, "os0", 32, 1024, 20},
                    Case{"floors", "walking", kDual, "os0", 16, 1024, 10},
                    Case{"stairs", "handheld", kLowRate, "os1", 128, 512, 20},
                    Case{"hill", "walking", kSingle, "os1", 128, 1024, 10},
                    Case{"parking", "wheeled", kLegacy, "os2", 32, 2048, 10},
                    Case{"street", "vehicle", kDual, "os1", 64, 1024, 20},
                    Case{"tunnel", "wheeled", kSingle, "os1", 64, 1024, 10},
                    Case{"tunnel-square", "wheeled", kLowRate, "os1", 32, 1024, 10},
                    Case{"tunnel-bare", "drone", kSingle, "os0", 16, 2048, 10},
                    Case{"plain-hall", "drone", kLegacy, "os0", 64, 512, 20},
                    Case{"plain-corridor", "handheld", kSingle, "os1", 32, 512, 10},
                    Case{"room", "handheld", kDual, "os2", 32, 1024, 10},
                    Case{"campus", "vehicle", kLowRate, "os2", 64, 2048, 10}),
    [](const auto& i) {
      std::string name = std::string(i.param.world) + "_" + i.param.motion;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
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
  SimulationOptions options = small_room();
  options.network = {.loss = 0.05, .duplicates = 0.05, .reordering = 0.05};
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

TEST(Simulation, TheCorridorsAxisIsBlindInItsMiddleAndARoomHasNone) {
  SimulationOptions options = small_room();
  options.world = "corridor";
  options.seconds = 30.0;
  options.sensor.beams = 16;
  Simulator corridor(options);
  LidarScan scan;
  ScanTruth truth;
  while (corridor.next(scan, truth)) {
  }
  ASSERT_EQ(truth.blind_axes.size(), 1U);
  EXPECT_GT(std::abs((truth.T_world_sensor.rotation * truth.blind_axes[0]).x()), 0.99);
  Simulator room(small_room());
  while (room.next(scan, truth)) EXPECT_TRUE(truth.blind_axes.empty());
}

// What was somewhere else at another time was on a moving thing, and nothing else was.
TEST(Simulation, PixelsOnMovingThingsAreNamed) {
  SimulationOptions options = small_room();
  options.world = "street";
  options.motion.kind = "wheeled";
  options.seconds = 2.0;
  options.sensor.beams = 64;
  options.noise.mixed_pixels = false;
  Simulator simulator(options);
  const XyzLut lut(simulator.info());
  LidarScan scan;
  ScanTruth truth;
  int moving = 0;
  int gone = 0;
  while (simulator.next(scan, truth)) {
    int counted = 0;
    for (const MovingRun& run : truth.moving) {
      counted += run.last_column - run.first_column + 1;
      const SensorTime time = scan.column_time[static_cast<std::size_t>(run.first_column)];
      const Eigen::Vector3d point_m =
          simulator.true_pose(time) *
          lut.point(run.row, run.first_column, scan.range_mm(run.row, run.first_column));
      const double t_s = simulator.timing().true_s(time);
      ASSERT_LT(simulator.scene().at(t_s).distance_to_surface_m(point_m), 0.1);
      ++moving;
      if (simulator.scene().at(t_s + 7.0).distance_to_surface_m(point_m) > 0.1) ++gone;
    }
    const auto points = std::count_if(scan.range_mm.data.begin(), scan.range_mm.data.end(),
                                      [](std::uint32_t range_mm) { return range_mm > 0; });
    EXPECT_NEAR(truth.moving_share, counted / static_cast<double>(points), 1e-9);
  }
  ASSERT_GT(moving, 50);
  EXPECT_GT(gone, 0.5 * moving);
}

TEST(Simulation, TheFirstScanLacksTheColumnsBeforeTheFirst) {
  SimulationOptions options = small_room();
  options.stream.first_column = 256;
  SyntheticSource source(options);
  ScanAssembler assembler(source.simulator().info());
  RawPacket packet;
  std::vector<double> completeness;
  while (source.read(packet) == SourceStatus::kPacket) {
    if (packet.port == source.simulator().info().lidar_port) assembler.push(packet.bytes);
    while (const LidarScan* scan = assembler.next()) completeness.push_back(scan->completeness());
  }
  ASSERT_EQ(completeness.size(), 3U);
  EXPECT_EQ(completeness, (std::vector<double>{0.5, 1.0, 1.0}));
  options.stream.first_column = 512;
  EXPECT_THROW(SyntheticSource{options}, OptionError);
}

TEST(Simulation, ARestartedSensorCountsAnewUnderAnotherInitId) {
  SimulationOptions options = small_room();
  options.seconds = 2.0;
  options.sensor.first_frame_id = 65534;
  options.stream = {.first_column = 0, .restart_at_s = 0.55, .restart_gap_s = 0.7};
  SyntheticSource source(options);
  ScanAssembler assembler(source.simulator().info());
  RawPacket packet;
  std::vector<int> frames;
  SensorTime last;
  while (source.read(packet) == SourceStatus::kPacket) {
    if (packet.port == source.simulator().info().lidar_port) assembler.push(packet.bytes);
    while (const LidarScan* scan = assembler.next()) {
      frames.push_back(scan->frame_id);
      EXPECT_GT(scan->end_time, last);
      last = scan->end_time;
    }
  }
  ASSERT_GE(frames.size(), 12U);
  EXPECT_EQ(std::vector<int>(frames.begin(), frames.begin() + 6),
            (std::vector<int>{65534, 65535, 0, 1, 2, 3}));
  EXPECT_EQ(frames[6], 0);
  EXPECT_EQ(assembler.counters().restarts, 1U);
}

TEST(Simulation, ImuPacketsComeBetweenLidarPacketsInTheOrderOfTime) {
  for (const ImuProfile profile : {ImuProfile::kLegacy, ImuProfile::kAccel32Gyro32Nmea}) {
    SimulationOptions options = small_room();
    options.motion.rest_s = 1.0;
    options.sensor.imu_profile = profile;
    SyntheticSource source(options);
    const SensorInfo& info = source.simulator().info();
    std::vector<ImuSample> samples;
    RawPacket packet;
    HostTime last;
    while (source.read(packet) == SourceStatus::kPacket) {
      EXPECT_GE(packet.host_time, last);
      last = packet.host_time;
      if (packet.port != info.imu_port) continue;
      ASSERT_TRUE(
          parse_imu_packet(ImuPacketFormat(info), packet.bytes, samples, CrcCheck::kRequired));
    }
    // 0.3 s at 100 Hz, in packets of ten or one.
    EXPECT_NEAR(static_cast<double>(samples.size()), 30.0, 10.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      EXPECT_NEAR(samples[i].acceleration_mps2.norm(), kGravity_mps2, 0.3);
      EXPECT_LT(samples[i].angular_rate_radps.norm(), 0.05);
      if (i > 0) {
        EXPECT_NEAR(static_cast<double>(samples[i].accel_time - samples[i - 1].accel_time), 1e7,
                    1e3);
      }
    }
  }
}

TEST(Simulation, AnUnknownWorldIsAnsweredWithTheKnownOnes) {
  SimulationOptions options;
  options.world = "moon";
  try {
    const Simulator simulator(options);
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("corridor"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace glint::synth
