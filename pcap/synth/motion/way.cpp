// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/way.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

constexpr double kLeastLeg_m = 1e-3;
// Tighter corners are turned on the spot.
constexpr double kLeastRadius_m = 0.1;
constexpr double kLeastTurn_rad = 1e-9;

// The corners one passes in one round; those of an open route there and back.
std::vector<Eigen::Vector3d> round_trip(const Route& route) {
  std::vector<Eigen::Vector3d> corners;
  const auto apart = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).head<2>().norm() > kLeastLeg_m;
  };
  for (const Eigen::Vector3d& point : route.points_m) {
    if (corners.empty() || apart(corners.back(), point)) corners.push_back(point);
  }
  while (route.closed && corners.size() > 1 && !apart(corners.back(), corners.front())) {
    corners.pop_back();
  }
  if (corners.size() < 2) throw OptionError("the world offers no way to move along");
  if (!route.closed) {
    for (std::size_t i = corners.size() - 2; i > 0; --i) corners.push_back(corners[i]);
  }
  return corners;
}

Eigen::Vector2d direction(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

// A corner and how it is rounded off.
struct Corner {
  Eigen::Vector3d point_m;
  double turn_rad;     // To the left.
  double radius_m;     // 0: turned on the spot.
  double trimmed_m;    // From either leg.
  Eigen::Vector3d in;  // Along the legs, of horizontal length 1.
  Eigen::Vector3d out;
};

std::vector<Corner> round_corners(const Route& route) {
  const std::vector<Eigen::Vector3d> points = round_trip(route);
  const std::size_t count = points.size();
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d before = points[i] - points[(i + count - 1) % count];
    const Eigen::Vector3d after = points[(i + 1) % count] - points[i];
    Corner corner{};
    corner.point_m = points[i];
    corner.in = before / before.head<2>().norm();
    corner.out = after / after.head<2>().norm();
    const double cross = corner.in.x() * corner.out.y() - corner.in.y() * corner.out.x();
    corner.turn_rad = std::atan2(cross, corner.in.head<2>().dot(corner.out.head<2>()));
    // Each leg gives half of itself to either of its corners.
    const double available_m = 0.5 * std::min(before.head<2>().norm(), after.head<2>().norm());
    const double tangent = std::tan(0.5 * std::abs(corner.turn_rad));
    const double radius_m = std::min(route.corner_radius_m, available_m / std::max(tangent, 1e-9));
    if (radius_m >= kLeastRadius_m) {
      corner.radius_m = radius_m;
      corner.trimmed_m = radius_m * tangent;
    }
    corners.push_back(corner);
  }
  return corners;
}

Way::Piece make_piece(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double turn_rad,
                      double flat_length_m) {
  Way::Piece piece{};
  piece.length_m = std::hypot(flat_length_m, to_m.z() - from_m.z());
  piece.turn_rad = turn_rad;
  piece.from_m = from_m.head<2>();
  piece.to_m = to_m.head<2>();
  piece.height_m = from_m.z();
  piece.slope = piece.length_m > 0.0 ? (to_m.z() - from_m.z()) / piece.length_m : 0.0;
  return piece;
}

}  // namespace

struct Way::Place {
  const Piece& piece;
  double into_m;  // Way from the piece's start.
  double rounds;
};

Way::Way(const Route& route, double base_m) : base_m_(base_m) {
  const std::vector<Corner> corners = round_corners(route);
  double heading_rad = std::atan2(corners[0].out.y(), corners[0].out.x());
  double turning_rad = 0.0;
  double height_integral = 0.0;
  const auto append = [&](Piece piece) {
    piece.start_m = length_m_;
    piece.heading_rad = heading_rad;
    piece.turning_rad = turning_rad;
    piece.height_integral = height_integral;
    pieces_.push_back(piece);
    length_m_ += piece.length_m;
    heading_rad += piece.turn_rad;
    turn_rad_ += piece.turn_rad;
    if (piece.length_m > 0.0) turning_rad += std::abs(piece.turn_rad);
    height_integral += piece.length_m * (piece.height_m + 0.5 * piece.slope * piece.length_m);
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& start = corners[i];
    const Corner& end = corners[(i + 1) % corners.size()];
    const Eigen::Vector3d from_m = start.point_m + start.trimmed_m * start.out;
    const Eigen::Vector3d to_m = end.point_m - end.trimmed_m * end.in;
    const double flat_m = (to_m - from_m).head<2>().norm();
    if (flat_m > kLeastLeg_m * kLeastLeg_m) append(make_piece(from_m, to_m, 0.0, flat_m));
    if (std::abs(end.turn_rad) < kLeastTurn_rad) continue;
    append(make_piece(to_m, end.point_m + end.trimmed_m * end.out, end.turn_rad,
                      end.radius_m * std::abs(end.turn_rad)));
  }
}

Way::Place Way::find(double way_m) const {
  const double rounds = std::floor(way_m / length_m_);
  const double within_m = std::clamp(way_m - rounds * length_m_, 0.0, length_m_);
  // Where several start, the last: the others are turns on the spot.
  const auto next =
      std::upper_bound(pieces_.begin(), pieces_.end(), within_m,
                       [](double m, const Piece& piece) { return m < piece.start_m; });
  const Piece& piece = *(next - 1);
  return {piece, std::min(within_m - piece.start_m, piece.length_m), rounds};
}

WayPoint Way::at(double way_m) const {
  const auto [piece, into_m, rounds] = find(way_m);
  const double fraction = piece.length_m > 0.0 ? into_m / piece.length_m : 1.0;
  WayPoint point;
  if (piece.turn_rad == 0.0 || piece.length_m == 0.0) {
    point.position_m.head<2>() = piece.from_m + fraction * (piece.to_m - piece.from_m);
  } else {
    // The chord of an arc is turned from its tangent by half the arc's angle.
    const double half_rad = 0.5 * piece.turn_rad;
    const double radius_m = 0.5 * (piece.to_m - piece.from_m).norm() / std::sin(half_rad);
    point.position_m.head<2>() =
        piece.from_m + 2.0 * radius_m * std::sin(half_rad * fraction) *
                           direction(piece.heading_rad + half_rad * fraction);
  }
  point.heading_rad = piece.heading_rad + fraction * piece.turn_rad + rounds * turn_rad_;
  const double behind_m = way_m - 0.5 * base_m_;
  const double ahead_m = way_m + 0.5 * base_m_;
  point.position_m.z() = (height_integral(ahead_m) - height_integral(behind_m)) / base_m_;
  point.slope = (height_m(ahead_m) - height_m(behind_m)) / base_m_;
  return point;
}

double Way::turning_rad(double way_m) const {
  const auto [piece, into_m, rounds] = find(way_m);
  const Piece& last = pieces_.back();
  const double round_rad = last.turning_rad + (last.length_m > 0.0 ? std::abs(last.turn_rad) : 0.0);
  const double here_rad =
      piece.length_m > 0.0 ? std::abs(piece.turn_rad) * into_m / piece.length_m : 0.0;
  return rounds * round_rad + piece.turning_rad + here_rad;
}

double Way::height_m(double way_m) const {
  const Place place = find(way_m);
  return place.piece.height_m + place.piece.slope * place.into_m;
}

double Way::height_integral(double way_m) const {
  const auto [piece, into_m, rounds] = find(way_m);
  const Piece& last = pieces_.back();
  const double round_integral =
      last.height_integral + last.length_m * (last.height_m + 0.5 * last.slope * last.length_m);
  return rounds * round_integral + piece.height_integral +
         into_m * (piece.height_m + 0.5 * piece.slope * into_m);
}

}  // namespace glint::synth
