// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What a sensor answers, as JSON: every state of a session goes through it.
#include "driver/session/fuzz_reply.hpp"
#include "tests/fuzz/require.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return glint::parse_reply_for_fuzzing({data, size});
}
