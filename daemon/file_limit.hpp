// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>

namespace glint::daemon {

/// Lets the process have `wanted` files open at a time, sockets among them, or as many as it may.
/// Returns how many that are.
std::size_t raise_file_limit(std::size_t wanted);

}  // namespace glint::daemon
