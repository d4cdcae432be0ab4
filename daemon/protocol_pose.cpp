// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_pose.hpp"

#include <fmt/format.h>

#include <cmath>

namespace glint::daemon {
namespace {

constexpr double kMaxPredictionMs = 200.0;

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Json vector_json(const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; }

void put_velocity(Json& out, Twist velocity, PoseFrames frames, const PoseContext& context) {
  if (frames.base) velocity = adjoint(context.T_base_sensor) * velocity;
  out["v_mps"] = vector_json(velocity.head<3>());
  out["w_radps"] = vector_json(velocity.tail<3>());
}

void put_covariance(Json& out, Matrix6d covariance, PoseFrames frames, const PoseContext& context) {
  if (frames.base) {
    const Matrix6d a = adjoint(context.T_base_sensor);
    covariance = a * covariance * a.transpose();
  }
  if (!covariance.allFinite()) return;  // Absent means unknown.
  Json cov = Json::array();
  for (const double value : covariance.reshaped<Eigen::RowMajor>()) cov.push_back(value);
  out["cov"] = std::move(cov);
}

/// The axes along or about which only the motion before told where the sensor is, in the frame of
/// the pose, and the deviation that has grown there.
void put_degenerate_axes(Json& out, const slam::OdometryEstimate& estimate, const Pose& T_map_odom,
                         PoseFrames frames) {
  Json axes = Json::array();
  for (const slam::WeakAxis& weak : estimate.weak_axes) {
    if (!weak.critical) continue;
    const Eigen::Vector3d in_sensor = estimate.T_odom_sensor.rotation.conjugate() * weak.axis;
    const Eigen::Index at = weak.rotation ? 3 : 0;
    const double variance = in_sensor.dot(estimate.covariance.block<3, 3>(at, at) * in_sensor);
    const Eigen::Vector3d axis = frames.map ? T_map_odom.rotation * weak.axis : weak.axis;
    axes.push_back(Json{{"kind", weak.rotation ? "rotation" : "translation"},
                        {"axis", vector_json(axis)},
                        {weak.rotation ? "sigma_rad" : "sigma_m", std::sqrt(variance)}});
  }
  out["degenerate_axes"] = std::move(axes);
}

void put_map_correction(Json& out, const Pose& T_map_odom, std::uint32_t epoch) {
  Json pose = Json::object();
  put_pose(pose, T_map_odom);
  out["T_map_odom"] = std::move(pose);
  out["map_epoch"] = epoch;
}

/// The members that every message about a pose begins with.
Json head_json(slam::TrackingState state, PoseFrames frames) {
  return Json{{"sensor", 0},
              {"state", slam::to_string(state)},
              {"frame", frames.map ? "map" : "odom"},
              {"child", frames.base ? "base" : "sensor"}};
}

/// As pose_in_frames, for a pose that the newest correction holds for.
Pose newest_in_frames(const Pose& T_odom_sensor, const Snapshot& snapshot, PoseFrames frames,
                      const PoseContext& context) {
  return pose_in_frames(T_odom_sensor, snapshot.correction.T_map_odom * T_odom_sensor, frames,
                        context);
}

/// Of the newest pose of the sensor: in a map that is only read it is as sure as its place there.
Matrix6d covariance_in(PoseFrames frames, const Snapshot& snapshot) {
  const slam::OdometryEstimate& estimate = *snapshot.estimate;
  const auto& certainty = snapshot.correction.certainty;
  return frames.map && certainty ? certainty->covariance_at(estimate.T_odom_sensor)
                                 : estimate.covariance;
}

/// What the time of a pose is worth: where it comes from, and when it was on this machine.
void put_clock(Json& out, ClockSource source, HostTime host_time, std::int64_t sigma_ns) {
  out["clock"] = to_string(source);
  if (host_time.ns == 0) return;  // Absent means unknown.
  out["t_host_ns"] = host_time.ns;
  out["clock_sigma_ns"] = sigma_ns;
}

[[noreturn]] void refuse_time(const TrajectoryHistory& history, SensorTime stamp) {
  if (history.first() == history.end()) {
    throw RpcError(kOutOfRange, "there is no pose yet", "at_ns");
  }
  const std::int64_t from = history.at(history.first()).stamp.ns;
  const std::int64_t to = history.at(history.end() - 1).stamp.ns;
  const bool covered = stamp.ns >= from && stamp.ns <= to;
  const char* why = covered ? "tracking restarted around at_ns; the covered span is {} to {}"
                            : "at_ns is outside the covered span {} to {}";
  throw RpcError(kOutOfRange, fmt::format(fmt::runtime(why), from, to), "at_ns",
                 Json{{"from_ns", from}, {"to_ns", to}});
}

[[noreturn]] void refuse_unplaced() {
  throw RpcError(kNotTracking,
                 "the sensor has not been found in the map yet; ask for frame \"odom\"", "frame");
}

Json past_pose_json(const Snapshot& snapshot, SensorTime stamp, PoseFrames frames,
                    const PoseContext& context) {
  const auto record = pose_at(snapshot.history, stamp);
  if (!record) refuse_time(snapshot.history, stamp);
  if (frames.map && !snapshot.correction.placed) refuse_unplaced();
  Json out = head_json(record->state, frames);
  put_time(out, stamp);
  put_clock(out, snapshot.clock_source, record->host_time, record->clock_sigma_ns);
  const slam::MapCorrection& correction = snapshot.correction;
  const Pose& T_odom_sensor = record->T_odom_sensor;
  const Pose T_map_sensor = correction.map_pose(record->segment, record->sequence, T_odom_sensor);
  put_pose(out, pose_in_frames(T_odom_sensor, T_map_sensor, frames, context));
  put_velocity(out, record->velocity, frames, context);
  const Pose T_map_odom =
      correction.anchors ? T_map_sensor * T_odom_sensor.inverse() : correction.T_map_odom;
  put_map_correction(out, T_map_odom, correction.epoch);
  out["interpolated"] = true;
  return out;
}

}  // namespace

PoseFrames pose_frames(const Json& params) {
  return {choice_param(params, "frame", "map|odom") == "map",
          choice_param(params, "child", "sensor|base") == "base"};
}

Pose pose_in_frames(const Pose& T_odom_sensor, const Pose& T_map_sensor, PoseFrames frames,
                    const PoseContext& context) {
  Pose pose = frames.map ? T_map_sensor : T_odom_sensor;
  if (frames.base) pose = pose * context.T_base_sensor.inverse();
  return pose;
}

void put_pose(Json& out, const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  out["p_m"] = vector_json(pose.translation_m);
  out["q_xyzw"] = Json{q.x(), q.y(), q.z(), q.w()};
}

Json epoch_json(const Snapshot& snapshot) {
  Json out = Json::object();
  if (snapshot.estimate) put_time(out, snapshot.estimate->stamp);
  put_map_correction(out, snapshot.correction.T_map_odom, snapshot.correction.epoch);
  return out;
}

Json newest_pose_json(const Snapshot& snapshot, PoseFrames frames, const PoseContext& context,
                      std::int64_t now_ns) {
  Json out = head_json(client_state(snapshot, now_ns, context.scan_period_ns), frames);
  if (!snapshot.estimate) return out;
  const slam::OdometryEstimate& estimate = *snapshot.estimate;
  put_time(out, estimate.stamp);
  put_clock(out, snapshot.clock_source, snapshot.host_time, snapshot.clock.sigma_ns);
  out["age_ms"] = static_cast<double>(now_ns - snapshot.arrival_ns) * 1e-6;
  out["stale"] = is_stale(snapshot, now_ns, context.scan_period_ns);
  const bool known = snapshot.correction.placed || !frames.map;
  if (known) {
    put_pose(out, newest_in_frames(estimate.T_odom_sensor, snapshot, frames, context));
    put_covariance(out, covariance_in(frames, snapshot), frames, context);
  }
  put_velocity(out, estimate.velocity, frames, context);
  if (snapshot.correction.placed) {
    put_map_correction(out, snapshot.correction.T_map_odom, snapshot.correction.epoch);
    if (snapshot.correction.certainty) out["confidence"] = snapshot.correction.confidence;
  } else {
    out["map_epoch"] = snapshot.correction.epoch;  // Absent means unknown.
    out["confidence"] = snapshot.correction.confidence;
  }
  out["frame_id"] = estimate.frame_id;
  out["segment"] = estimate.segment;
  out["completeness"] = estimate.completeness;
  put_degenerate_axes(out, estimate, snapshot.correction.T_map_odom, frames);
  return out;
}

Json get_pose(const Json& params, const Snapshot& snapshot, const PoseContext& context,
              std::int64_t now_ns) {
  const PoseFrames frames = pose_frames(params);
  const auto at = time_param(params, "at");
  const double predict_ms = number_param(params, "predict_ms", 0.0, 0.0, kMaxPredictionMs);
  if (at && predict_ms > 0.0) {
    throw RpcError(kInvalidParams, "at_ns and predict_ms exclude each other", "predict_ms");
  }
  if (at) return past_pose_json(snapshot, *at, frames, context);

  Json out = newest_pose_json(snapshot, frames, context, now_ns);
  if (predict_ms == 0.0 || !out.contains("p_m")) return out;
  const slam::OdometryEstimate& estimate = *snapshot.estimate;
  const Pose predicted = estimate.T_odom_sensor * se3_exp(estimate.velocity * (predict_ms * 1e-3));
  const std::int64_t ahead_ns = std::llround(predict_ms * 1e6);
  put_time(out, estimate.stamp + ahead_ns);
  if (out.contains("t_host_ns")) out["t_host_ns"] = snapshot.host_time.ns + ahead_ns;
  put_pose(out, newest_in_frames(predicted, snapshot, frames, context));
  out.erase("cov");  // That of the newest pose says nothing about what came after it.
  out["predicted_ms"] = predict_ms;
  return out;
}

}  // namespace glint::daemon
