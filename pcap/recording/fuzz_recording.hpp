// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

/// Reads bytes as the contents of a recording, whatever they are: format, messages, metadata. For
/// fuzzing; must return, without a crash and in bounded time. Leaves no file behind.
void fuzz_recording(ByteSpan contents);

}  // namespace glint::recording
