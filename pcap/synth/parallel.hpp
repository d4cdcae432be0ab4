// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>

namespace glint::synth {

/// Calls work(0) ... work(count - 1), in any order and on any threads, and returns when all are
/// done. The caller's: this library starts no threads. Results do not depend on it.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& work)>;

/// One after the other, on the calling thread.
inline void serial_for(int count, const std::function<void(int)>& work) {
  for (int i = 0; i < count; ++i) work(i);
}

}  // namespace glint::synth
