// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace glint {

/// The line below a stream of points that scatter upwards only, such as delays: the smallest value
/// of each quarter second of the last minute is kept, and the line is the edge of their lower
/// convex hull that lies under the centre of their weights, which grow towards the newest. That
/// edge is the line below all points with the least weighted sum of distances to them [Moon,
/// Skelly & Towsley 1999, "Estimation and removal of clock skew from network delay measurements"].
/// All in nanoseconds. Memory is constant, a point costs O(1) amortised. Thread-compatible.
class LowerEnvelope {
 public:
  /// Takes a point. One that is older than the open quarter second is not used: it is late anyway.
  void add(std::int64_t time_ns, std::int64_t value_ns);
  /// Forgets all points, but goes on with the slope until there is a new one.
  void restart();

  /// Points taken since the start.
  [[nodiscard]] std::uint64_t points() const { return points_; }
  /// The line at a time; 0 before the first point.
  [[nodiscard]] double at(std::int64_t time_ns) const;
  /// Of the line, 1e-6 is 1 ppm; 0 until there are points of two seconds.
  [[nodiscard]] double slope() const { return slope_; }
  /// How far the line may be off, by the scatter of the newest minima about it.
  [[nodiscard]] double sigma_ns() const;

 private:
  struct Point {
    std::int64_t time_ns = 0;
    std::int64_t value_ns = 0;
  };
  static constexpr std::int64_t kWindow_ns = 250'000'000;
  static constexpr std::size_t kWindows = 240;

  void open_window(Point point);
  void close_window();
  void fit();
  void fit_slope();
  [[nodiscard]] const Point& minimum(std::size_t index) const;
  [[nodiscard]] double residual(const Point& point) const;

  std::array<Point, kWindows> minima_{};  ///< A ring; the oldest is at first_.
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t points_ = 0;
  std::int64_t window_begin_ns_ = 0;
  Point open_;  ///< Minimum of the window that is being filled.
  Point base_;  ///< A point of the line.
  double slope_ = 0.0;
  bool sloped_ = false;  ///< The slope is of the points, not just what there was before.
};

}  // namespace glint
