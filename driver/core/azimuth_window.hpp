// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "driver/core/metadata_json.hpp"

namespace glint {

/// The part of the turn that a sensor was told to send (its config key `azimuth_window`). Value
/// type.
struct AzimuthWindow {
  double begin_deg = 0.0;
  double end_deg = 360.0;  ///< Below begin_deg when the window wraps.

  /// From one end to the other, in (0, 360] degrees.
  [[nodiscard]] double width_deg() const;
  /// First and last measurement id inside, of `columns` a turn: column m looks along
  /// 360 (1 - m / columns) degrees, and the end is not part of the window.
  [[nodiscard]] std::pair<int, int> columns(int columns) const;
};

/// Reads the key: thousandths of a degree, but hundredths in firmware 1.x. Null when it is absent.
/// @throws MetadataError when it is no two angles of a turn.
std::optional<AzimuthWindow> read_azimuth_window(const MetadataGroup& config, int firmware_major);

/// A sentence on a window so narrow that its unit was mistaken: people type 360. Empty if it is
/// not.
std::string azimuth_window_warning(const AzimuthWindow& window, int firmware_major);

}  // namespace glint
