// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// ROS 1 bags, ROS 2 bags, MCAP and OSF files.
#include "pcap/recording/fuzz_recording.hpp"

#include "tests/fuzz/require.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  glint::recording::fuzz_recording(glint::fuzz::as_bytes(data, size));
  return 0;
}
