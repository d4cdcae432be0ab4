// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>
#include <cstdint>

namespace glint::daemon {

/// How many requests a client may make: so many a second, and those of one second at once.
/// Thread-compatible.
class RequestBudget {
 public:
  RequestBudget(double per_s, std::int64_t now_ns)
      : per_s_(per_s), most_(std::max(1.0, per_s)), left_(most_), filled_ns_(now_ns) {}

  /// Takes one; false when none is left. `now_ns`: steady clock.
  bool take(std::int64_t now_ns) {
    constexpr double kSecondsPerNs = 1e-9;
    const double passed_s = static_cast<double>(now_ns - filled_ns_) * kSecondsPerNs;
    left_ = std::min(most_, left_ + passed_s * per_s_);
    filled_ns_ = now_ns;
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  const double per_s_;
  const double most_;
  double left_;
  std::int64_t filled_ns_;
};

}  // namespace glint::daemon
