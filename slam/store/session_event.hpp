// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

#include "driver/core/time.hpp"

namespace glint::slam {

/// An event for the session file: `data` is a JSON object.
struct SessionEvent {
  SensorTime stamp;
  std::string kind;
  std::string data;
};

}  // namespace glint::slam
