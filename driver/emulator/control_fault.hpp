// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

namespace glint::emulator {

/// What may go wrong with an answer of the emulated sensor's HTTP server.
enum class ControlFault {
  kServerError,  ///< 500.
  kSlow,         ///< Answers after all patience has ended.
  kGarbage,      ///< Bytes that are no HTTP.
  kNoJson,       ///< HTTP that carries something else than JSON.
  kHalfAnswer,   ///< The connection breaks off within the body.
};

/// A fault for the next answers. Value type.
struct ControlFaultPlan {
  ControlFault fault = ControlFault::kServerError;
  int count = 1;     ///< Answers that it spoils.
  std::string path;  ///< Only requests whose target contains this; empty: any.
};

}  // namespace glint::emulator
