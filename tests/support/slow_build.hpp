// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

namespace glint::test {

/// How many times slower than a release build the tests must expect this one to be: what feeds live
/// threads waits that much longer between scans, and gives up that much later.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kSlowdown = 10;
#else
inline constexpr int kSlowdown = 1;
#endif

}  // namespace glint::test
