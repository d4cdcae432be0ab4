// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "driver/core/error.hpp"

namespace glint::synth {

/// A world, sensor or length that cannot be simulated: wrong use rather than bad input. The message
/// says what is possible.
class OptionError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace glint::synth
