// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/session_status.hpp"

namespace glint {

std::string_view to_string(SessionState state) {
  switch (state) {
    case SessionState::kDiscovering:
      return "DISCOVERING";
    case SessionState::kConfiguring:
      return "CONFIGURING";
    case SessionState::kWaitingData:
      return "WAITING_DATA";
    case SessionState::kRunning:
      return "RUNNING";
    case SessionState::kStalled:
      return "STALLED";
  }
  return "DISCOVERING";
}

}  // namespace glint
