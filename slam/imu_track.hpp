// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "driver/core/imu_packet.hpp"
#include "driver/core/time.hpp"

namespace glint::slam {

/// What an IMU measured from a time `a` to a time `b`, in the sensor frame at `a`. Value type.
struct ImuMotion {
  /// R_a_b: takes directions in the sensor frame at `b` to that at `a`.
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  /// Specific force integrated once and twice: the velocity and the way that a body gains which was
  /// at rest at `a`, as if nothing weighed anything. Gravity is to be added.
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d way_m = Eigen::Vector3d::Zero();
};

/// The IMU's measurements of the last seconds, integrated: turns less the gyroscope's bias, which
/// is learned from the turns that registration finds, and specific force. Motions between any two
/// times come from it without integrating anew [Forster et al. 2017, "On-Manifold Preintegration",
/// sec. VI]. Thread-compatible; no allocation after construction.
class ImuTrack {
 public:
  ImuTrack();

  /// Takes the measurements in the order of their times; a gap or a time that goes back begins
  /// anew, the bias stays.
  void add(const ImuSample& sample);
  /// Null where there are no measurements about both times. Past the last one the motion goes on
  /// for a few milliseconds. `b` may be before `a`.
  [[nodiscard]] std::optional<ImuMotion> between(SensorTime a, SensorTime b) const;
  /// Deviation of a turn over so long a time and so far, rad, an axis.
  [[nodiscard]] double turn_sigma_rad(double span_s, double turn_rad) const;
  /// Registration found this turn, good to `sigma_rad` an axis: the bias follows.
  void learn_bias(SensorTime a, SensorTime b, const Eigen::Quaterniond& R_a_b, double sigma_rad);

  [[nodiscard]] const Eigen::Vector3d& bias_radps() const { return bias_radps_; }
  [[nodiscard]] double bias_sigma_radps() const { return bias_sigma_radps_; }

 private:
  /// The state of a body that moves as measured, in the frame in which the track began.
  struct Node {
    SensorTime time;
    Eigen::Vector3d rate_radps;  ///< Less the bias as it was known then.
    Eigen::Vector3d force_mps2;
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
    Eigen::Vector3d way_m = Eigen::Vector3d::Zero();
  };

  [[nodiscard]] const Node& node(std::size_t steps_back) const {
    return nodes_[(next_ + nodes_.size() - 1 - steps_back) % nodes_.size()];
  }
  [[nodiscard]] std::optional<Node> state(SensorTime t) const;
  static void advance(Node& from, const Eigen::Vector3d& rate_radps,
                      const Eigen::Vector3d& force_mps2, double dt_s);
  void begin_at_rest();

  std::vector<Node> nodes_;  ///< A ring of the last `count_`; `next_` is the place to be taken.
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  Eigen::Vector3d bias_radps_ = Eigen::Vector3d::Zero();
  double bias_sigma_radps_;
  std::optional<SensorTime> learned_;  ///< Up to when the bias was learned.
};

}  // namespace glint::slam
