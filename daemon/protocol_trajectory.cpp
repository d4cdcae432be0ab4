// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <charconv>

#include "daemon/protocol_pose.hpp"

namespace glint::daemon {
namespace {

/// Poses a page: some 350 bytes each, so a page stays well below the longest line.
constexpr std::uint64_t kPagePoses = 2000;

std::uint64_t parse_pose_cursor(const Json& cursor) {
  if (cursor.is_string()) {
    const auto& text = cursor.get_ref<const std::string&>();
    std::uint64_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error == std::errc{} && end == text.data() + text.size()) return index;
  }
  throw RpcError(kInvalidParams, "cursor must be the next_cursor of an earlier answer", "cursor");
}

}  // namespace

Json get_trajectory(const Json& params, const Snapshot& snapshot, const PoseContext& context,
                    std::int64_t now_ns) {
  const PoseFrames frames = pose_frames(params);
  const auto since = time_param(params, "since");
  const TrajectoryHistory& history = snapshot.history;

  std::uint64_t begin = since ? history.first_after(*since) : history.first();
  std::uint64_t skipped = 0;
  if (const Json* cursor = find_param(params, "cursor")) {
    const std::uint64_t wanted = parse_pose_cursor(*cursor);
    begin = std::clamp(wanted, history.first(), history.end());
    skipped = begin > wanted ? begin - wanted : 0;
  }
  // None is known in a map in which the sensor has not been found.
  const bool known = snapshot.correction.placed || !frames.map;
  const std::uint64_t end = known ? std::min(history.end(), begin + kPagePoses) : begin;

  Json poses = Json::array();
  for (std::uint64_t i = begin; i < end; ++i) {
    const PoseRecord& record = history.at(i);
    Json pose = Json::object();
    put_time(pose, record.stamp);
    pose["state"] = slam::to_string(record.state);
    pose["frame_id"] = record.frame_id;
    pose["segment"] = record.segment;
    const Pose T_map_sensor =
        snapshot.correction.map_pose(record.segment, record.sequence, record.T_odom_sensor);
    put_pose(pose, pose_in_frames(record.T_odom_sensor, T_map_sensor, frames, context));
    poses.push_back(std::move(pose));
  }

  Json out{{"sensor", 0},
           {"state", slam::to_string(client_state(snapshot, now_ns, context.scan_period_ns))}};
  if (snapshot.estimate) put_time(out, snapshot.estimate->stamp);
  out["frame"] = frames.map ? "map" : "odom";
  out["child"] = frames.base ? "base" : "sensor";
  out["map_epoch"] = snapshot.correction.epoch;
  out["poses"] = std::move(poses);
  // Too slow a reader: these poses were no longer kept.
  if (skipped > 0) out["skipped"] = skipped;
  if (known && end < history.end()) out["next_cursor"] = std::to_string(end);
  return out;
}

}  // namespace glint::daemon
