// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/file_limit.hpp"

#include <sys/resource.h>

#include <algorithm>

namespace glint::daemon {

std::size_t raise_file_limit(std::size_t wanted) {
  rlimit limit{};
  // Who may not even ask has what it has.
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
  const rlim_t before = limit.rlim_cur;
  if (before >= wanted) return before;
  limit.rlim_cur = std::min<rlim_t>(wanted, limit.rlim_max);
  return setrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : before;
}

}  // namespace glint::daemon
