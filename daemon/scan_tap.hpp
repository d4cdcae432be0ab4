// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::daemon {

/// A scan to look at. Immutable once it is shared.
struct TappedScan {
  LidarScan scan;
  Image<std::uint8_t> filtered;            ///< What features are taken from, destaggered.
  std::shared_ptr<const SensorInfo> info;  ///< Never null.
  SensorTime stamp;                        ///< As clients are told it.
};

/// Lets those who ask look at the latest scan. While nobody asks odometry copies nothing.
/// Thread-safe.
class ScanTap {
 public:
  /// From now on, for a few seconds, scans are kept; what was kept before is too old to be shown.
  /// `now_ns`: steady clock.
  void ask(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (now_ns > wanted_until_ns_.load()) latest_.reset();
    wanted_until_ns_.store(now_ns + kInterest_ns);
  }
  [[nodiscard]] bool wanted(std::int64_t now_ns) const { return now_ns < wanted_until_ns_.load(); }
  void put(std::shared_ptr<const TappedScan> scan) {
    const std::lock_guard lock(mutex_);
    latest_ = std::move(scan);
    changed_.notify_all();
  }
  /// The latest scan; null when none comes within `limit`.
  std::shared_ptr<const TappedScan> latest(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, limit, [&] { return latest_ != nullptr; });
    return latest_;
  }

 private:
  /// Who looks every second still finds the latest scan.
  static constexpr std::int64_t kInterest_ns = 3'000'000'000;

  std::atomic<std::int64_t> wanted_until_ns_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const TappedScan> latest_;  ///< Guarded by mutex_.
};

}  // namespace glint::daemon
