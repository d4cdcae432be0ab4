// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <stdexcept>
#include <string>

namespace glint {

/// Bad input found at set-up: a file, a capture, metadata, a configuration. The message is one
/// sentence that names the thing, says what is wrong with it, and how to mend it.
/// Tools exit with 3 on it. The hot path never throws; it counts.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Sensor metadata that cannot be used, or that contradicts the packets.
class MetadataError : public InputError {
 public:
  using InputError::InputError;
};

/// A network address that is written wrongly, or of the wrong kind: waiting will not make it right,
/// as it may one of an interface that is not up yet.
class AddressError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace glint
