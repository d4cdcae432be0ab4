// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/lower_envelope.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr std::int64_t kMemory_ns = 60'000'000'000;
// Over less, the noise of two minima is more than the slope of any clock.
constexpr std::int64_t kShortestSlope_ns = 2'000'000'000;
// What a slope that is not known yet may be: crystals keep within 100 ppm of each other.
constexpr double kUnknownSlope = 50e-6;
// How late a first packet may be; the smallest of n independent delays is n times less.
constexpr double kFirstDelay_ns = 10e6;
// Minima that tell how good the line is now.
constexpr std::size_t kNewest = 16;
constexpr double kLeastSigma_ns = 1000.0;
// Where the centre of weights lies that grow linearly from 0.
constexpr double kCentre = 2.0 / 3.0;

}  // namespace

void LowerEnvelope::add(std::int64_t time_ns, std::int64_t value_ns) {
  const Point point{time_ns, value_ns};
  if (points_++ == 0) {
    base_ = point;
    open_window(point);
    return;
  }
  if (time_ns < window_begin_ns_) return;
  if (time_ns - window_begin_ns_ >= kWindow_ns) {
    close_window();
    open_window(point);
  } else if (residual(point) < residual(open_)) {
    open_ = point;
  }
  // The line is below every point at once, not only from the next fit on.
  if (residual(point) < 0.0) base_ = point;
}

void LowerEnvelope::restart() {
  count_ = 0;
  points_ = 0;
  sloped_ = false;
}

double LowerEnvelope::at(std::int64_t time_ns) const {
  if (points_ == 0) return 0.0;
  return static_cast<double>(base_.value_ns) +
         slope_ * static_cast<double>(time_ns - base_.time_ns);
}

double LowerEnvelope::sigma_ns() const {
  const std::size_t newest = std::min(count_, kNewest);
  double sum = 0.0;
  for (std::size_t i = count_ - newest; i < count_; ++i) {
    const double distance = residual(minimum(i));
    sum += distance * distance;
  }
  const double scatter = newest == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(newest));
  const double first = kFirstDelay_ns / static_cast<double>(std::max<std::uint64_t>(1, points_));
  const double drift =
      sloped_ ? 0.0 : kUnknownSlope * static_cast<double>(open_.time_ns - base_.time_ns);
  return std::max(kLeastSigma_ns, std::hypot(scatter, first, drift));
}

void LowerEnvelope::open_window(Point point) {
  window_begin_ns_ = point.time_ns;
  open_ = point;
}

void LowerEnvelope::close_window() {
  if (count_ == kWindows) {
    first_ = (first_ + 1) % kWindows;
    --count_;
  }
  minima_[(first_ + count_++) % kWindows] = open_;
  while (open_.time_ns - minimum(0).time_ns > kMemory_ns) {
    first_ = (first_ + 1) % kWindows;
    --count_;
  }
  fit();
}

// Without points enough for a slope, the line of the known slope below them.
void LowerEnvelope::fit() {
  if (open_.time_ns - minimum(0).time_ns >= kShortestSlope_ns) {
    fit_slope();
    return;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (i == 0 || residual(minimum(i)) < 0.0) base_ = minimum(i);
  }
}

void LowerEnvelope::fit_slope() {
  const auto slope = [&](const Point& a, const Point& b) {
    return static_cast<double>(b.value_ns - a.value_ns) /
           static_cast<double>(b.time_ns - a.time_ns);
  };
  // Lower hull from left to right [Andrew 1979]: its slopes rise.
  std::array<std::size_t, kWindows> hull{};
  std::size_t size = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    while (size >= 2 && slope(minimum(hull[size - 2]), minimum(i)) <=
                            slope(minimum(hull[size - 2]), minimum(hull[size - 1]))) {
      --size;
    }
    hull[size++] = i;
  }
  const auto span_ns = static_cast<double>(open_.time_ns - minimum(0).time_ns);
  const std::int64_t centre_ns = minimum(0).time_ns + std::llround(kCentre * span_ns);
  std::size_t end = 1;
  while (end + 1 < size && minimum(hull[end]).time_ns < centre_ns) ++end;
  base_ = minimum(hull[end - 1]);
  slope_ = slope(base_, minimum(hull[end]));
  sloped_ = true;
}

const LowerEnvelope::Point& LowerEnvelope::minimum(std::size_t index) const {
  return minima_[(first_ + index) % kWindows];
}

double LowerEnvelope::residual(const Point& point) const {
  return static_cast<double>(point.value_ns) - at(point.time_ns);
}

}  // namespace glint
