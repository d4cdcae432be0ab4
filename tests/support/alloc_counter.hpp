// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

namespace glint::test {

/// Calls of malloc and its kin by all threads since the process began, operator new included. Link
/// alloc_counter.cpp into one executable only: it replaces the allocator's entry points there.
std::uint64_t heap_allocations();

/// False under a sanitizer, which needs the entry points itself; nothing is counted then.
bool heap_allocations_are_counted();

}  // namespace glint::test
