// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "tests/support/alloc_counter.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GLINT_SANITIZED 1
#endif
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GLINT_SANITIZED 1
#endif
#endif

namespace {

constinit std::atomic<std::uint64_t> allocations = 0;

}  // namespace

#ifndef GLINT_SANITIZED

// The C library's own entry points, behind the public names replaced here.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): their names are given.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t size) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = aligned_alloc(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
}

#endif

namespace glint::test {

std::uint64_t heap_allocations() { return allocations.load(std::memory_order_relaxed); }

bool heap_allocations_are_counted() {
#ifdef GLINT_SANITIZED
  return false;
#else
  return true;
#endif
}

}  // namespace glint::test
