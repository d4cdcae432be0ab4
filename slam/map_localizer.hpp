// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loops/map_sight.hpp"
#include "slam/loops/relocalizer.hpp"
#include "slam/map_correction.hpp"

namespace glint::slam {

/// Where a sensor is in a map that nothing is added to. It is looked for until it is found; then
/// each keyframe is laid on the map around it, and a Kalman filter over the pose in the map weighs
/// that against what odometry says of the way since the keyframe before. A keyframe that does not
/// fit (a part that the map lacks, things that were moved) leaves it to odometry, and is also
/// looked for in all of the map. After kMostMisfits of these in a row, or when tracking restarts in
/// a new segment, the place is lost and the search begins anew. Deterministic. Thread-compatible.
class MapLocalizer {
 public:
  /// So many keyframes, some 50 m of way, may follow one another without one that fits.
  static constexpr int kMostMisfits = 100;
  /// The pose in the map may not be less sure than this, m and rad (one deviation).
  static constexpr double kMostSigma_m = 1.0;
  static constexpr double kMostSigma_rad = 0.2;

  /// `map`: knows all of its keyframes.
  explicit MapLocalizer(Relocalizer map);

  /// `correction` becomes what is known after that keyframe or probe: it is changed only by this
  /// class. Its epoch steps when the place is lost, when it is found, and when it turns out to be
  /// farther off than 0.1 m or 0.02 rad; its confidence falls from 1 to 0 with the misfits.
  void process(const Keyframe& keyframe, MapCorrection& correction);
  /// The place is forgotten and looked for anew, near `guess` first.
  void search_anew(const std::optional<PlaceGuess>& guess, MapCorrection& correction);

  /// Since the first scan that was looked for; zero when the place is known.
  [[nodiscard]] double searching_s() const;
  /// Whether the last process() gave up the guess that the search began with.
  [[nodiscard]] bool guess_dropped() const { return map_.guess_dropped(); }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  /// The pose after a keyframe.
  struct Track {
    std::uint64_t id = 0;
    std::uint32_t segment = 0;
    Pose T_odom_sensor;
    Pose T_map_sensor;
    Matrix6 covariance;  ///< Of T_map_sensor, right perturbation, m^2 and rad^2.
    int misfits = 0;     ///< In a row.
  };

  void search(const Keyframe& scan, MapCorrection& correction);
  void follow(const Keyframe& keyframe, MapCorrection& correction);
  void begin_track(const Keyframe& scan, const Relocation& found);
  [[nodiscard]] Track predicted(const Keyframe& keyframe) const;
  static bool update(Track& track, const MapFix& fix);
  void lose(MapCorrection& correction);
  void tell(const Keyframe& scan, MapCorrection& correction) const;

  Relocalizer map_;
  MapSight sight_;
  std::optional<Track> track_;  ///< While the place is known.
  std::optional<SensorTime> search_begin_;
  SensorTime stamp_;  ///< Of the last scan.
};

}  // namespace glint::slam
