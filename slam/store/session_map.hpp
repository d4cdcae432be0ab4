// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>

#include "slam/map.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::slam {

/// What became of the points of things that moved in a session.
enum class MovingInSession {
  kRemoved,      ///< Its keyframes do not have them.
  kToBeLeftOut,  ///< They do, and a map leaves them out (MovingPoints).
  kWanted,       ///< They do, and a map has them.
};
MovingInSession moving_in_session(const SessionReader& session);

/// The edge of the voxels of its map.
double session_voxel_m(const SessionReader& session);

/// The map of a session: made of its keyframes as the back end made its own, but with the poses
/// that they have in the end. `voxel_m`: edge of its voxels; 0 for the session's own.
/// @throws InputError as SessionReader.
std::shared_ptr<const MapSnapshot> session_map(const SessionReader& session, double voxel_m = 0.0);

}  // namespace glint::slam
