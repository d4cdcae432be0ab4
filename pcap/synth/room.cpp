// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "pcap/synth/decoration.hpp"
#include "pcap/synth/world.hpp"

namespace glint::synth {
namespace {

constexpr double kHalfLength_m = 6.0;
constexpr double kHalfWidth_m = 4.5;
// The way round the furniture in the middle: an ellipse.
constexpr double kPathA_m = 3.4;
constexpr double kPathB_m = 2.4;

// An ellipse by its arc length, counter-clockwise.
class Ellipse {
 public:
  Ellipse(double a_m, double b_m, double start_rad) : a_m_(a_m), b_m_(b_m), start_rad_(start_rad) {
    // Arc length at equal steps of the angle.
    length_m_.push_back(0.0);
    for (int i = 0; i < kSteps; ++i) {
      const double phi = (i + 0.5) * kStep_rad;
      length_m_.push_back(length_m_.back() +
                          kStep_rad * std::hypot(a_m_ * std::sin(start_rad_ + phi),
                                                 b_m_ * std::cos(start_rad_ + phi)));
    }
  }

  [[nodiscard]] PathPoint at(double way_m) const {
    const double rounds = std::floor(way_m / length_m_.back());
    const double s_m = way_m - rounds * length_m_.back();
    double phi = start_rad_ + 2.0 * M_PI * s_m / length_m_.back();
    // Newton's method on the table, whose steps are fine enough for a linear look-up.
    for (int i = 0; i < 20; ++i) {
      const double speed = std::hypot(a_m_ * std::sin(phi), b_m_ * std::cos(phi));
      const double error_m = length_at(phi - start_rad_) - s_m;
      phi -= error_m / speed;
      if (std::abs(error_m) < 1e-12) break;
    }
    return {a_m_ * std::cos(phi), b_m_ * std::sin(phi),
            std::atan2(b_m_ * std::cos(phi), -a_m_ * std::sin(phi))};
  }

 private:
  static constexpr int kSteps = 20000;
  static constexpr double kStep_rad = 2.0 * M_PI / kSteps;

  [[nodiscard]] double length_at(double angle_rad) const {
    const double x = angle_rad / kStep_rad;
    const double i = std::clamp(std::floor(x), 0.0, kSteps - 1.0);
    const auto k = static_cast<std::size_t>(i);
    return length_m_[k] + (x - i) * (length_m_[k + 1] - length_m_[k]);
  }

  double a_m_;
  double b_m_;
  double start_rad_;
  std::vector<double> length_m_;
};

void add_walls(Scene& scene, Random& random) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double height_m = random.uniform(2.7, 3.3);
  const double length_m = 2 * kHalfLength_m;
  const double width_m = 2 * kHalfWidth_m;
  const Eigen::Vector3d corner(-kHalfLength_m, -kHalfWidth_m, 0.0);
  scene.add({corner, x, z, length_m, height_m, decorated_wall(length_m, height_m, random)});
  scene.add(
      {corner + width_m * y, x, z, length_m, height_m, decorated_wall(length_m, height_m, random)});
  scene.add({corner, y, z, width_m, height_m, decorated_wall(width_m, height_m, random)});
  scene.add(
      {corner + length_m * x, y, z, width_m, height_m, decorated_wall(width_m, height_m, random)});
  scene.add({corner, x, y, length_m, width_m, tiled_floor(length_m, width_m, random)});
  scene.add(
      {corner + height_m * z, x, y, length_m, width_m, tiled_ceiling(length_m, width_m, random)});
}

// Things along the walls and on an island in the middle, clear of the path.
void add_furniture(Scene& scene, Random& random) {
  for (int i = 0; i < 10; ++i) {
    const bool along_length = random.uniform() < 0.6;
    const bool far_side = random.uniform() < 0.5;
    const Eigen::Vector3d size(random.uniform(0.5, 1.4), random.uniform(0.3, 0.6),
                               random.uniform(0.5, 2.0));
    const double depth_m = 0.5 * size.y() + 0.02;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    if (along_length) {
      at.x() = random.uniform(-kHalfLength_m + 1.0, kHalfLength_m - 1.0);
      at.y() = (far_side ? 1 : -1) * (kHalfWidth_m - depth_m);
    } else {
      at.y() = random.uniform(-kHalfWidth_m + 1.0, kHalfWidth_m - 1.0);
      at.x() = (far_side ? 1 : -1) * (kHalfLength_m - depth_m);
    }
    scene.add_box(at, size, along_length ? 0.0 : 0.5 * M_PI, furniture(random));
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d size(random.uniform(0.4, 0.9), random.uniform(0.4, 0.9),
                               random.uniform(0.6, 1.8));
    const Eigen::Vector3d at(random.uniform(-1.4, 1.4), random.uniform(-0.6, 0.6), 0.0);
    scene.add_box(at, size, random.uniform(0.0, M_PI), furniture(random));
  }
}

}  // namespace

World make_room(std::uint64_t seed) {
  Random random{seed, 0x4003ULL};
  Scene scene;
  add_walls(scene, random);
  add_furniture(scene, random);
  const auto path =
      std::make_shared<const Ellipse>(kPathA_m, kPathB_m, random.uniform(0.0, 2.0 * M_PI));
  Itinerary itinerary;
  itinerary.rest(1.0);
  itinerary.circle([path](double s) { return path->at(s); }, random.uniform(0.8, 1.2));
  return {std::move(scene), WalkingMotion(std::move(itinerary), 1.3, seed)};
}

}  // namespace glint::synth
