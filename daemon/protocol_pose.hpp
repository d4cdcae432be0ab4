// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>

#include "daemon/protocol.hpp"
#include "daemon/snapshot.hpp"

namespace glint::daemon {

/// Which pose a client wants: of `child` in `frame`.
struct PoseFrames {
  bool map = true;    ///< Frame map; else odom.
  bool base = false;  ///< Child base; else sensor.
};

/// What it takes to tell a pose beside the snapshot.
struct PoseContext {
  Pose T_base_sensor;
  std::int64_t scan_period_ns = 0;
};

/// Reads `frame` (map|odom) and `child` (sensor|base). @throws RpcError.
PoseFrames pose_frames(const Json& params);

/// The pose of the child in the frame, given that of the sensor in either. For child sensor it is
/// the very same bits.
Pose pose_in_frames(const Pose& T_odom_sensor, const Pose& T_map_sensor, PoseFrames frames,
                    const PoseContext& context);

// Puts p_m and q_xyzw in.
void put_pose(Json& out, const Pose& pose);

/// What the event `epoch` tells: the correction of the map that came into force.
Json epoch_json(const Snapshot& snapshot);

/// The newest pose, as get_pose and the pose notification tell it. `now_ns`: steady clock.
Json newest_pose_json(const Snapshot& snapshot, PoseFrames frames, const PoseContext& context,
                      std::int64_t now_ns);

/// get_pose, with at_ns and predict_ms. @throws RpcError.
Json get_pose(const Json& params, const Snapshot& snapshot, const PoseContext& context,
              std::int64_t now_ns);

/// get_trajectory: a page of past poses. @throws RpcError.
Json get_trajectory(const Json& params, const Snapshot& snapshot, const PoseContext& context,
                    std::int64_t now_ns);

}  // namespace glint::daemon
