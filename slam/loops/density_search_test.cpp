// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/density_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "slam/loops/loop_detector.hpp"
#include "slam/loops/test_gallery.hpp"

namespace glint::slam {
namespace {

constexpr float kSensorHeight_m = 1.2F;

/// A hall 40 m by 24 m with boxes standing about, seen without any keypoint.
class Hall {
 public:
  explicit Hall(unsigned seed, float mirror = 1.0F, bool walls = true) {
    std::mt19937 layout(seed);
    std::uniform_real_distribution<float> part(0.0F, 1.0F);
    if (walls) add_box({-20.0F, -12.0F}, {40.0F, 24.0F}, 4.0F);
    for (int i = 0; i < 26; ++i) {
      const Eigen::Vector2f size_m(0.5F + 2.5F * part(layout), 0.5F + 2.5F * part(layout));
      add_box({-18.0F + 34.0F * part(layout), -10.0F + 18.0F * part(layout)}, size_m,
              1.0F + 2.0F * part(layout));
    }
    for (int i = 0; i < 4000; ++i) {
      points_m_.emplace_back(40.0F * part(layout) - 20.0F, 24.0F * part(layout) - 12.0F, 0.0F);
    }
    for (auto& point_m : points_m_) point_m.y() *= mirror;
  }

  Keyframe look(const Pose& T_world_sensor, std::uint64_t id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.estimate.T_odom_sensor = T_world_sensor;
    keyframe.estimate.stamp = SensorTime{static_cast<std::int64_t>(id) * kNsPerSecond / 2};
    const Pose T_sensor_world = T_world_sensor.inverse();
    std::normal_distribution<float> noise(0.0F, 0.01F);
    for (const Eigen::Vector3f& point_m : points_m_) {
      if (random_() % 4 != 0) continue;
      const Eigen::Vector3f p = (T_sensor_world * point_m.cast<double>()).cast<float>();
      keyframe.points.push_back(
          {p.x() + noise(random_), p.y() + noise(random_), p.z() + noise(random_), 0.0F});
    }
    return keyframe;
  }

 private:
  void add_box(const Eigen::Vector2f& corner_m, const Eigen::Vector2f& size_m, float height_m) {
    constexpr float kStep_m = 0.25F;
    for (float z = 0.2F; z < height_m; z += kStep_m) {
      for (float x = 0.0F; x <= size_m.x(); x += kStep_m) {
        points_m_.emplace_back(corner_m.x() + x, corner_m.y(), z);
        points_m_.emplace_back(corner_m.x() + x, corner_m.y() + size_m.y(), z);
      }
      for (float y = 0.0F; y <= size_m.y(); y += kStep_m) {
        points_m_.emplace_back(corner_m.x(), corner_m.y() + y, z);
        points_m_.emplace_back(corner_m.x() + size_m.x(), corner_m.y() + y, z);
      }
    }
  }

  std::vector<Eigen::Vector3f> points_m_;
  std::mt19937 random_{5};
};

Pose hall_pose(double x_m, double y_m, double yaw_rad) {
  Pose pose;
  pose.rotation = so3_exp({0.0, 0.0, yaw_rad});
  pose.translation_m = {x_m, y_m, static_cast<double>(kSensorHeight_m)};
  return pose;
}

/// The local map of a few keyframes at a place, by an odometry that calls `heading_rad` ahead.
DensityMap map_at(Hall& hall, double x_m, double y_m, double heading_rad) {
  std::vector<Place> places;
  Pose turn;
  turn.rotation = so3_exp({0.0, 0.0, heading_rad});
  for (int i = 0; i < 5; ++i) {
    Place place = make_place(hall.look(hall_pose(x_m + 0.5 * i, y_m, 0.3), 0));
    place.T_odom_sensor = turn * hall_pose(x_m + 0.5 * i, y_m, 0.3);
    places.push_back(std::move(place));
  }
  return make_density_map(places.back(), places);
}

std::vector<DensityHit> ask(Hall& known, Hall& seen, double heading_rad) {
  DensityIndex index;
  index.add(map_at(known, -2.0, 0.5, 0.0));
  const std::array asked{std::size_t{0}};
  return index.query(map_at(seen, 0.5, -0.5, heading_rad), asked);
}

TEST(DensityIndex, FindsAPlaceTurnedByAnyAngle) {
  Hall hall(1);
  for (int i = 0; i < 12; ++i) {
    const double heading_rad = -3.0 + 0.5 * i;
    const auto hits = ask(hall, hall, heading_rad);
    ASSERT_EQ(hits.size(), 1U) << heading_rad;
    EXPECT_GE(hits[0].corners, 12);
    const Pose& T = hits[0].T_older_current;
    EXPECT_LT(so3_log(so3_exp({0.0, 0.0, heading_rad}) * T.rotation).norm(), 0.03);
    EXPECT_LT((T.translation_m - Eigen::Vector3d(2.5, -1.0, 0.0)).norm(), 0.3);
  }
}

TEST(DensityIndex, AMirroredPlaceIsAnotherOne) {
  // Without the outer walls: a rectangle is its own mirror image.
  Hall hall(1, 1.0F, false);
  Hall mirrored(1, -1.0F, false);
  for (int i = 0; i < 12; ++i) {
    const auto same = ask(hall, hall, -3.0 + 0.5 * i);
    ASSERT_EQ(same.size(), 1U);
    // A straight side fits another.
    for (const DensityHit& hit : ask(hall, mirrored, -3.0 + 0.5 * i)) {
      EXPECT_LT(5 * hit.corners, same[0].corners);
    }
  }
}

TEST(DensityIndex, AnotherPlaceIsNotFound) {
  Hall hall(1);
  for (unsigned seed = 2; seed < 8; ++seed) {
    Hall other(seed);
    EXPECT_TRUE(ask(hall, other, 0.2 * seed).empty()) << seed;
  }
}

/// Along the hall and back, then round again by an odometry that has drifted; no keypoints.
struct HallWalk {
  explicit HallWalk(bool density) : detector(default_vocabulary(), density) {}

  void go(Hall& hall, double from_m, double to_m) {
    const double ahead = to_m > from_m ? 1.0 : -1.0;
    for (double x_m = from_m; (to_m - x_m) * ahead > 0; x_m += 0.5 * ahead) {
      const Pose truth = hall_pose(x_m, 0.0, ahead > 0 ? 0.0 : M_PI);
      Keyframe keyframe = hall.look(truth, truths.size());
      keyframe.estimate.T_odom_sensor = drift * truth;
      truths.push_back(truth);
      for (const LoopEdge& edge : detector.add(keyframe)) edges.push_back(edge);
    }
  }

  LoopDetector detector;
  Pose drift;
  std::vector<Pose> truths;
  std::vector<LoopEdge> edges;
};

std::vector<LoopEdge> there_and_back(bool density, double rise_m, double* worst = nullptr) {
  Hall hall(1);
  HallWalk walk(density);
  walk.go(hall, -15.0, 15.0);
  walk.drift.rotation = so3_exp({0.0, 0.0, 0.1});
  walk.drift.translation_m = {1.5, -1.0, rise_m};
  walk.go(hall, 15.0, -15.0);
  if (worst != nullptr) *worst = worst_error(walk.edges, walk.truths);
  return walk.edges;
}

TEST(DensitySearch, FindsTheWayBackWithoutAKeypoint) {
  double worst = 0.0;
  EXPECT_GE(there_and_back(true, 0.0, &worst).size(), 4U);
  EXPECT_LT(worst, 0.05);
  EXPECT_TRUE(there_and_back(false, 0.0).empty()) << "nothing else finds them";
}

TEST(DensitySearch, AnotherStoreyOfTheSameMakeStaysApart) {
  EXPECT_TRUE(there_and_back(true, 2.8).empty());
}

bool loop_between(Hall& first, Hall& second) {
  HallWalk walk(true);
  walk.go(first, -15.0, 15.0);
  walk.go(second, 15.0, -15.0);
  return !walk.edges.empty();
}

TEST(DensitySearch, AnotherHallIsNoLoop) {
  Hall hall(1);
  Hall other(2);
  EXPECT_FALSE(loop_between(hall, other));
}

TEST(DensitySearch, NorIsTheMirroredOne) {
  Hall hall(1);
  Hall mirrored(1, -1.0F);
  EXPECT_FALSE(loop_between(hall, mirrored));
}

TEST(DensitySearch, RepeatsBitForBit) {
  const auto first = there_and_back(true, 0.0);
  const auto second = there_and_back(true, 0.0);
  ASSERT_FALSE(first.empty());
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].from, second[i].from);
    EXPECT_EQ(first[i].T_from_to.translation_m, second[i].T_from_to.translation_m);
    EXPECT_EQ(first[i].covariance, second[i].covariance);
  }
}

TEST(DensitySearch, AsksNoMoreMapsHoweverLongItStays) {
  Hall hall(1);
  DensitySearch search;
  std::vector<Place> places(1000, make_place(hall.look(hall_pose(0.0, 0.0, 0.0), 0)));
  // Most are left empty, for speed.
  for (std::size_t i = 0; i + 25 < places.size(); ++i)
    places[i].points_m = std::vector{places[i].points_m[0]};
  search.keep(places);
  search.propose(places, 900);
  EXPECT_EQ(search.asked(), DensitySearch::kMostAsked);
  EXPECT_TRUE(search.propose(places, 0).empty());
  EXPECT_EQ(search.asked(), 0U);
}

}  // namespace
}  // namespace glint::slam
