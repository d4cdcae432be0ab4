// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/azimuth_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double kTurn_deg = 360.0;

constexpr int kUnitsPerDegree = 1000;
constexpr int kOldUnitsPerDegree = 100;

}  // namespace

double AzimuthWindow::width_deg() const {
  const double width = end_deg - begin_deg;
  return width > 0.0 ? width : width + kTurn_deg;
}

std::pair<int, int> AzimuthWindow::columns(int columns) const {
  if (width_deg() >= kTurn_deg) return {0, columns - 1};
  const auto column_at = [&](double azimuth_deg) {
    return static_cast<int>(std::floor(columns * (1.0 - azimuth_deg / kTurn_deg)));
  };
  if (width_deg() < kTurn_deg / columns) {
    return {column_at(begin_deg) % columns, column_at(begin_deg) % columns};
  }
  // Columns turn against the azimuth, so the window's end is its first column.
  return {(column_at(end_deg) + 1) % columns, column_at(begin_deg) % columns};
}

std::optional<AzimuthWindow> read_azimuth_window(const MetadataGroup& config, int firmware_major) {
  constexpr const char* kKey = "azimuth_window";
  const auto ends = config.integers(kKey, 0, 360 * kUnitsPerDegree);
  if (!ends) return std::nullopt;
  if (ends->size() != 2) config.fail(kKey, "must hold two angles; get the metadata again");
  // Tools that write metadata anew use the present unit whatever the firmware.
  const bool old = firmware_major == 1 && std::ranges::max(*ends) <= 360 * kOldUnitsPerDegree;
  const int units = old ? kOldUnitsPerDegree : kUnitsPerDegree;
  return AzimuthWindow{static_cast<double>(ends->front()) / units,
                       static_cast<double>(ends->back()) / units};
}

std::string azimuth_window_warning(const AzimuthWindow& window, int firmware_major) {
  constexpr double kSuspicious_deg = 1.0;
  if (window.width_deg() >= kSuspicious_deg) return {};
  return fmt::format(
      "the azimuth window is {:.3g} degrees wide; in this firmware's unit a whole turn is 0 to {}",
      window.width_deg(), 360 * (firmware_major == 1 ? kOldUnitsPerDegree : kUnitsPerDegree));
}

}  // namespace glint
