// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <mutex>
#include <optional>
#include <utility>

#include "slam/loops/relocalizer.hpp"

namespace glint::daemon {

/// The sensor's place is to be looked for anew, near the guess first if there is one.
struct PlaceSearchRequest {
  std::optional<slam::PlaceGuess> guess;
};

/// From whoever asks for a search to the back end. The newest request counts. Thread-safe; nobody
/// waits.
class PlaceSearchSlot {
 public:
  void post(PlaceSearchRequest request) {
    const std::lock_guard lock(mutex_);
    request_ = std::move(request);
  }
  [[nodiscard]] std::optional<PlaceSearchRequest> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(request_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<PlaceSearchRequest> request_;
};

}  // namespace glint::daemon
