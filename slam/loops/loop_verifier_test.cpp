// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_verifier.hpp"

#include <gtest/gtest.h>

#include <random>

#include "slam/loops/look_alike.hpp"
#include "slam/loops/test_gallery.hpp"

namespace glint::slam {
namespace {

/// Pairs that agree on `motion`, the first `good` of them, and others that do not.
std::vector<PointPair> make_pairs(const Pose& motion, int good, int all) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-8.0, 8.0);
  std::normal_distribution<double> noise(0.0, 0.03);
  std::vector<PointPair> pairs;
  for (int i = 0; i < all; ++i) {
    const Eigen::Vector3d current_m(place(random), place(random), 0.3 * place(random));
    const Eigen::Vector3d other_m(place(random), place(random), 0.3 * place(random));
    const Eigen::Vector3d error_m(noise(random), noise(random), noise(random));
    pairs.push_back({i < good ? motion * current_m + error_m : other_m, current_m, 1.0});
  }
  return pairs;
}

Pose about_turned() {
  Pose pose;
  pose.rotation = so3_exp({0.02, -0.03, 2.8});
  pose.translation_m = {1.2, -0.8, 0.1};
  return pose;
}

TEST(PairConsensus, FindsAnyMotionAmongHalfWrongPairs) {
  const Consensus found = find_consensus(make_pairs(about_turned(), 50, 100));
  EXPECT_GE(found.inliers.size(), 48U);
  EXPECT_LE(found.inliers.size(), 54U);
  EXPECT_EQ(found.sectors, 8);
  const Pose error = about_turned().inverse() * found.T_reference_current;
  EXPECT_LT(error.translation_m.norm(), 0.03);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.01);
}

TEST(PairConsensus, FindsNothingInNoise) {
  EXPECT_LT(find_consensus(make_pairs(about_turned(), 0, 100)).inliers.size(), 12U);
  EXPECT_TRUE(find_consensus({}).inliers.empty());
}

TEST(PairConsensus, ParallelPairsOnALineFixNoMotion) {
  std::vector<PointPair> line;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d at_m(0.2 * i, 1.0, 0.0);
    line.push_back({at_m, at_m, 1.0});
  }
  EXPECT_TRUE(find_consensus(line).inliers.empty());
}

/// The surfaces of a gallery, as keyframes see them.
SurfaceMap gallery_map(TestGallery& gallery) {
  SurfaceMap map(0.5F, 20000);
  for (double x_m = 13.0; x_m <= 17.0; x_m += 1.0) {
    const Pose pose = gallery_pose(x_m, 0.0, 0.0);
    for (const auto& point_m : make_place(gallery.look(pose, 0, 0.0)).points_m) {
      map.add((pose * point_m.cast<double>()).cast<float>());
    }
  }
  return map;
}

TEST(SurfaceRegistration, SaysThatACorridorsWallsLeaveItsAxisOpen) {
  TestGallery gallery;
  SurfaceMap map = gallery_map(gallery);
  const Pose truth = gallery_pose(15.2, 0.3, 0.4);
  const Place place = make_place(gallery.look(truth, 1, 0.0));
  const Pose start = gallery_pose(15.2, 0.1, 0.35);
  const auto found = register_on_surfaces(map, place.points_m, {}, start);
  ASSERT_TRUE(found.ok);
  EXPECT_EQ(found.weak_axes, 1);
  EXPECT_NEAR(found.T_map_scan.translation_m.y(), 0.3, 0.02);
  EXPECT_LT(so3_log(found.T_map_scan.rotation.conjugate() * truth.rotation).norm(), 0.01);
  // Along the corridor and across it, in the frame of the scan.
  const Eigen::Matrix3d position = found.covariance.topLeftCorner<3, 3>();
  const Eigen::Vector3d along = truth.rotation.conjugate() * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d across = truth.rotation.conjugate() * Eigen::Vector3d::UnitY();
  EXPECT_GT(std::sqrt(along.dot(position * along)), 5.0);
  EXPECT_LT(std::sqrt(across.dot(position * across)), 0.1);
}

TEST(SurfaceRegistration, KeypointsSayWhereAlongACorridor) {
  TestGallery gallery;
  SurfaceMap map = gallery_map(gallery);
  const Pose truth = gallery_pose(15.2, 0.3, 0.4);
  const Keyframe scan = gallery.look(truth, 1, 0.0);
  std::vector<PointTerm> keypoints;
  for (std::size_t i = 0; i < 40; ++i) {
    const Eigen::Vector3d& point_m = scan.features.points_m[i];
    keypoints.push_back({point_m, truth * point_m, kKeypointWeight});
  }
  const auto found = register_on_surfaces(map, make_place(scan).points_m, keypoints,
                                          gallery_pose(15.4, 0.2, 0.38));
  ASSERT_TRUE(found.ok);
  EXPECT_LT((found.T_map_scan.translation_m - truth.translation_m).norm(), 0.03);
  const Eigen::Vector3d along = truth.rotation.conjugate() * Eigen::Vector3d::UnitX();
  EXPECT_LT(std::sqrt(along.dot(found.covariance.topLeftCorner<3, 3>() * along)), 0.1);
}

TEST(LoopVerifier, ThereAndBackIsOnePlace) {
  TestGallery gallery;
  std::vector<Place> before;
  for (int i = 0; i < 5; ++i) {
    before.push_back(make_place(gallery.look(gallery_pose(13.0 + i, 0.0, 0.0), 3 + i, i)));
  }
  const Pose back = gallery_pose(15.4, -0.4, 3.0);
  const Place current = make_place(gallery.look(back, 20, 60.0));
  LoopVerifier verifier;
  LoopCandidate candidate;
  const Consensus start = verifier.match(before[2], current, candidate);
  ASSERT_EQ(candidate.reason, "");
  LoopEdge edge;
  ASSERT_TRUE(verifier.registered(before[2], before, current, start, candidate, edge))
      << candidate.reason;
  EXPECT_EQ(edge.from, 5U);
  EXPECT_EQ(edge.to, 20U);
  const Pose error = (gallery_pose(15.0, 0.0, 0.0).inverse() * back).inverse() * edge.T_from_to;
  EXPECT_LT(error.translation_m.norm(), 0.05);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.01);
  EXPECT_GT(candidate.overlap, 0.8);
}

TEST(LoopVerifier, PlacesOfOneShapeWithOtherMarksAreRefused) {
  TestGallery gallery;
  const Place here = make_place(gallery.look(gallery_pose(5.0, 0.0, 0.0), 0, 0.0));
  const Place there = make_place(gallery.look(gallery_pose(25.0, 0.0, 0.0), 1, 60.0));
  LoopVerifier verifier;
  LoopCandidate candidate;
  verifier.match(here, there, candidate);
  EXPECT_EQ(candidate.reason, "too few keypoints agree");
}

TEST(ComparePlaces, APictureTellsTwoPlacesOfOneMakeApart) {
  TestGallery galleries(2, 1);
  const Pose here = gallery_pose(12.0, 0.0, 0.0);
  const Place pictured = make_place(galleries.look(here, 0, 0.0));
  const Place again = make_place(galleries.look(here, 1, 60.0));
  const Place bare = make_place(galleries.look(gallery_pose(12.0, 0.0, 0.0, 1), 2, 90.0));
  const std::span<const Place> around(&pictured, 1);
  const Comparison same = compare_places(pictured, around, again, {});
  EXPECT_GT(same.confirmed, 0.75);
  EXPECT_EQ(same.contradictions, 0);
  // The picture hangs in the older place alone: seen from the bare one nothing lacks.
  EXPECT_EQ(compare_places(pictured, around, bare, {}).contradictions, 0);
  EXPECT_GT(compare_places(bare, std::span<const Place>(&bare, 1), pictured, {}).contradictions, 0);
}

}  // namespace
}  // namespace glint::slam
