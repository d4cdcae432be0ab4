// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "daemon/protocol.hpp"
#include "slam/loops/relocalizer.hpp"

namespace glint::daemon {

/// Parameters of set_initial_pose, a pose in frame `map`: `{p_m, q_xyzw?, child?: sensor|base,
/// sigma_m?}`, or in place of the first two `T: [x, y, z, qx, qy, qz, qw]`. Without a rotation the
/// heading is not known. @throws RpcError naming the field.
slam::PlaceGuess parse_place_guess(const Json& params, const Pose& T_base_sensor);

}  // namespace glint::daemon
