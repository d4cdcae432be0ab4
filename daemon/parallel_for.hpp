// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "pcap/synth/parallel.hpp"

namespace glint::daemon {

/// Shares the calls among `threads` threads, the caller's among them; those that help it live as
/// long as one round of calls.
synth::ParallelFor parallel_for(int threads);

}  // namespace glint::daemon
