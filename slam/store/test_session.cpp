// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/test_session.hpp"

#include <sqlite3.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <random>
#include <set>

namespace glint::slam::test {
namespace {

namespace fs = std::filesystem;

using Random = std::mt19937;

float uniform(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

Features features(Random& random, std::size_t count) {
  Features out;
  for (std::size_t i = 0; i < count; ++i) {
    out.keypoints.push_back({uniform(random, 0.0F, 1024.0F), uniform(random, 0.0F, 64.0F),
                             uniform(random, -3.0F, 3.0F), static_cast<int>(i % 2),
                             uniform(random, 0.0F, 1e-2F)});
    out.descriptors.push_back({random(), random(), random(), random()});
    const Eigen::Vector3f point_m(uniform(random, -50, 50), uniform(random, -50, 50),
                                  uniform(random, -3, 3));
    out.points_m.push_back(point_m.cast<double>());
  }
  return out;
}

Eigen::Matrix<double, 6, 6> covariance(Random& random) {
  Eigen::Matrix<double, 6, 6> out;
  for (double& value : out.reshaped()) value = uniform(random, 0.0F, 1e-3F);
  return out;
}

}  // namespace

Keyframe sample_keyframe(std::uint64_t id, std::size_t points, std::size_t keypoints) {
  Random random(static_cast<std::uint32_t>(id));
  Keyframe k;
  k.id = id;
  k.estimate.sequence = 3 * id;
  k.estimate.frame_id = static_cast<std::uint32_t>(3 * id) & 0xFFFFU;
  k.estimate.stamp = {static_cast<std::int64_t>(id) * 1'000'000'000};
  k.estimate.T_odom_sensor.translation_m.x() = static_cast<double>(id);
  k.estimate.T_odom_sensor.rotation = so3_exp({0.0, 0.01, 0.001 * static_cast<double>(id)});
  k.estimate.state = id % 2 == 0 ? TrackingState::kTracking : TrackingState::kDegraded;
  k.estimate.completeness = 0.75;
  k.estimate.covariance = covariance(random);
  k.edge_covariance = covariance(random);
  if (id % 3 != 0) k.gravity = {{0.0, 0.6, 0.8}, Eigen::Matrix3d::Identity() * 0.9, 0.004};
  for (std::size_t i = 0; i < points; ++i) {
    k.points.push_back({uniform(random, -120, 120), uniform(random, -120, 120),
                        uniform(random, -5, 5), uniform(random, 0, 255)});
  }
  k.features = features(random, keypoints);
  return k;
}

Pose sample_map_pose(std::uint64_t id) {
  return {so3_exp({0.001, 0.0, 0.002 * static_cast<double>(id)}),
          {static_cast<double>(id), 0.5, -0.25}};
}

LoopEdge sample_loop(std::uint64_t from, std::uint64_t to) {
  Random random(static_cast<std::uint32_t>(from * 1000 + to));
  return {from, to, {so3_exp({0.1, 0.0, 0.5}), {1.0, -2.0, 0.5}}, covariance(random)};
}

SensorInfo sample_sensor() {
  SensorInfo info;
  info.pixels_per_column = 64;
  info.columns_per_frame = 1024;
  info.columns_per_packet = 16;
  info.column_window = {0, 1023};
  info.beam_altitude_deg.assign(64, 1.0);
  info.beam_azimuth_deg.assign(64, 0.5);
  info.pixel_shift_by_row.assign(64, 0);
  info.lidar_mode = "1024x10";
  return info;
}

std::string query(const fs::path& file, const std::string& sql) {
  sqlite3* db = nullptr;
  sqlite3_open_v2(file.c_str(), &db, SQLITE_OPEN_READONLY, nullptr);
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr);
  std::string value;
  if (sqlite3_step(statement) == SQLITE_ROW) {
    const void* data = sqlite3_column_blob(statement, 0);
    value.assign(static_cast<const char*>(data),
                 static_cast<std::size_t>(sqlite3_column_bytes(statement, 0)));
  }
  sqlite3_finalize(statement);
  sqlite3_close(db);
  return value;
}

std::string read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

InDirectory::InDirectory()
    : directory_(fs::temp_directory_path() /
                 ("glint-" +
                  std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + '-' +
                  std::to_string(getpid()))) {
  fs::create_directories(directory_);
}

InDirectory::~InDirectory() {
  std::error_code ignored;
  fs::remove_all(directory_, ignored);
}

std::string InDirectory::files() const {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory_)) {
    names.insert(entry.path().filename().string());
  }
  std::string out;
  for (const std::string& name : names) out += name + ' ';
  return out;
}

}  // namespace glint::slam::test
