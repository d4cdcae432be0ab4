// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Lines of the daemon's protocol, and what its methods make of their parameters.
#include "daemon/protocol.hpp"
#include "daemon/protocol_map.hpp"
#include "daemon/protocol_pose.hpp"
#include "tests/fuzz/require.hpp"

namespace {

namespace daemon = glint::daemon;
using daemon::Json;
using glint::fuzz::require;

// A second of poses, 0.1 s and 0.1 m apart.
const daemon::Snapshot& some_snapshot() {
  static const daemon::Snapshot snapshot = [] {
    daemon::Snapshot made;
    for (int i = 0; i < 10; ++i) {
      glint::slam::OdometryEstimate estimate;
      estimate.stamp = glint::SensorTime{1'000'000'000LL + i * 100'000'000LL};
      estimate.T_odom_sensor.translation_m.x() = 0.1 * i;
      estimate.state = glint::slam::TrackingState::kTracking;
      made.history.append({.stamp = estimate.stamp,
                           .T_odom_sensor = estimate.T_odom_sensor,
                           .state = estimate.state,
                           .host_time = {}});
      made.estimate = estimate;
    }
    return made;
  }();
  return snapshot;
}

const glint::slam::MapSnapshot& some_map() {
  static const auto map = [] {
    glint::slam::VoxelMap voxels(0.1, 1000);
    std::vector<glint::slam::MapPoint> points(50);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].x_m = static_cast<float>(i);
    voxels.insert({}, points);
    return voxels.snapshot();
  }();
  return *map;
}

/// A line that a client can read.
void check_line(const std::string& line) {
  require(line.ends_with('\n') && line.find('\n') == line.size() - 1, "an answer is one line");
  require(Json::accept(line), "an answer is JSON");
}

template <class Method>
void call(const daemon::Request& request, Method method) {
  try {
    check_line(daemon::result_line(request.id, method(request.params)));
  } catch (const daemon::RpcError& error) {
    check_line(daemon::error_line(request.id, error));
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parsed = daemon::parse_request(glint::fuzz::as_text(data, size));
  if (const auto* bad = std::get_if<daemon::BadRequest>(&parsed)) {
    check_line(daemon::error_line(bad->id, bad->error));
    return 0;
  }
  const auto& request = std::get<daemon::Request>(parsed);
  constexpr std::int64_t kNow_ns = 2'000'000'000;
  const daemon::PoseContext context{{}, 100'000'000};
  // Whatever the method's name, so that none must be guessed.
  call(request, [&](const Json& params) {
    return daemon::get_pose(params, some_snapshot(), context, kNow_ns);
  });
  call(request, [&](const Json& params) {
    return daemon::get_trajectory(params, some_snapshot(), context, kNow_ns);
  });
  call(request, [&](const Json& params) {
    return daemon::map_page(daemon::parse_map_query(params), some_map());
  });
  return 0;
}
