// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/parallel_for.hpp"

#include <atomic>
#include <thread>
#include <vector>

namespace glint::daemon {

synth::ParallelFor parallel_for(int threads) {
  return [threads](int count, const std::function<void(int)>& work) {
    std::atomic<int> next = 0;
    const auto take = [&] {
      for (int i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::jthread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back(take);
    take();
  };
}

}  // namespace glint::daemon
