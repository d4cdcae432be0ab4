// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/degeneracy.hpp"
#include "slam/image_projection.hpp"
#include "slam/joint_terms.hpp"
#include "slam/scan_images.hpp"

namespace glint::slam {

/// What patches say of a scan's pose. Value type.
struct PatchVotes {
  QuadraticTerm term;  ///< In whitened units.
  int patches = 0;     ///< That look as they did.
  int sectors = 0;     ///< Of eight all around, that they are in.
};

/// Small pieces of the intensity image on surfaces that earlier scans saw, looked for where they
/// should be in the present one: intensity as a residual along axes that geometry leaves open
/// [after Pfreundschuh et al. 2024, "COIN-LIO", sec. III-C]. Unlike keypoints they need no corner:
/// a joint or a line across the way is enough. Thread-compatible; owned by the odometry thread.
class PatchTracker {
 public:
  PatchTracker(const SensorInfo& info, std::shared_ptr<const XyzLut> lut);

  /// The images and the motion to the reference time of each column (none: a rigid scan) of the
  /// scan that is asked about next. Both are to stay as they are until the last question.
  void observe(const ScanImages& images, std::span<const Pose> T_reference_column);
  /// Where along the weak axes the patches look most as they did: a few decimetres about `start`.
  /// Without enough of them `start` itself.
  [[nodiscard]] Pose search(const Pose& start, const WeakAxes& axes) const;
  /// How they speak for other poses near T_odom_scan.
  [[nodiscard]] PatchVotes votes(const Pose& T_odom_scan) const;
  /// Takes leave of patches that are out of sight, old or no longer alike, and takes new ones that
  /// tell the way along the weak axes. Without any such axis all are given up.
  void renew(const Pose& T_odom_scan, const WeakAxes& axes);
  /// Whether new ones are looked for in every second scan only, while there are enough.
  void set_sparing(bool sparing) { sparing_ = sparing; }
  void clear() { patches_.clear(); }
  [[nodiscard]] std::size_t size() const { return patches_.size(); }

 private:
  static constexpr int kHalfWidth = 3;
  static constexpr int kHalfHeight = 1;
  static constexpr std::size_t kPixels =
      std::size_t{2 * kHalfWidth + 1} * std::size_t{2 * kHalfHeight + 1};
  using Values = Eigen::Matrix<float, static_cast<int>(kPixels), 1>;

  struct Patch {
    std::array<Eigen::Vector3d, kPixels>
        points_m;   ///< Odometry frame; the middle one in the middle.
    Values values;  ///< Zero mean, unit variance.
    int age = 0;    ///< Scans.
  };
  struct Look {
    Values values;
    float deviation = 0.0F;
    Eigen::Matrix<float, static_cast<int>(kPixels), 6> jacobian;  ///< Of normalised values.
  };
  struct Candidate {
    float score;
    int row;
    int u;
  };

  [[nodiscard]] bool in_sight(const Patch& patch, const Pose& T_scan_odom,
                              Pose& T_column_scan) const;
  [[nodiscard]] bool look(const Patch& patch, const Pose& T_odom_scan, bool jacobian,
                          Look& seen) const;
  [[nodiscard]] double likeness(const Pose& T_odom_scan) const;
  [[nodiscard]] Eigen::Vector3d point_at(int row, int u) const;
  [[nodiscard]] float score(int row, int u, std::span<const Eigen::Vector3d> axes) const;
  void find_candidates(const Pose& T_odom_scan, const WeakAxes& axes);
  [[nodiscard]] bool make(const Candidate& candidate, const Pose& T_odom_scan, Patch& patch) const;

  ImageProjection projection_;
  std::shared_ptr<const XyzLut> lut_;
  std::vector<int> shift_;
  std::vector<Patch> patches_;
  std::vector<Candidate> candidates_;
  bool sparing_ = false;
  bool spared_last_ = false;  ///< In the last scan no new ones were looked for.
  const ScanImages* images_ = nullptr;
  std::span<const Pose> T_reference_column_;
};

}  // namespace glint::slam
