// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/loops/place.hpp"
#include "slam/store/compression.hpp"
#include "slam/store/feature_codec.hpp"
#include "slam/store/point_codec.hpp"
#include "slam/store/test_session.hpp"
#include "slam/store/value_codec.hpp"
#include "slam/store/words_codec.hpp"

namespace glint::slam {
namespace {

TEST(PointCodec, PointsComeBackToHalfAQuantum) {
  std::vector<MapPoint> points = test::sample_keyframe(7, 5000).points;
  points.push_back({-900'000.0F, 900'000.0F, 0.0F, 300.0F});
  const auto back = decode_points(encode_points(points));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), points.size());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    // Half a quantum, and what a float resolves at 120 m.
    const double limit_m = kPointQuantum_m / 2 + 1e-5;
    EXPECT_NEAR((*back)[i].x_m, points[i].x_m, limit_m);
    EXPECT_NEAR((*back)[i].y_m, points[i].y_m, limit_m);
    EXPECT_NEAR((*back)[i].z_m, points[i].z_m, limit_m);
    EXPECT_NEAR((*back)[i].intensity, points[i].intensity, 0.5);
  }
  EXPECT_EQ(back->back().intensity, 255.0F);
  EXPECT_NEAR(back->back().x_m, -900'000.0, 0.1);
}

TEST(PointCodec, WhatIsNoPlaceIsLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<MapPoint> points{
      {kNan, 0, 0, 1}, {0, kInfinity, 0, 1}, {0, 0, -2e6F, 1}, {1, 2, 3, kNan}};
  const auto back = decode_points(encode_points(points));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), 1U);
  EXPECT_FLOAT_EQ(back->front().y_m, 2.0F);
}

TEST(PointCodec, NoPointsAreNoPoints) {
  const auto back = decode_points(encode_points({}));
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->empty());
}

// Every byte of a short encoding, changed or cut off. Some of Zstandard's bits say nothing.
template <class Decode, class Encode>
void expect_damage_is_seen(const std::vector<std::byte>& bytes, Decode decode, Encode encode) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] ^= std::byte{0x01};
    const auto read = decode(damaged);
    EXPECT_TRUE(!read || encode(*read) == bytes) << "byte " << i;
    EXPECT_FALSE(decode(std::span(bytes).first(i))) << "cut at " << i;
  }
}

TEST(PointCodec, DamageIsSeen) {
  expect_damage_is_seen(encode_points(test::sample_keyframe(1, 40).points), &decode_points,
                        &encode_points);
}

TEST(PointCodec, CountsThatLieAskForNoMemory) {
  std::vector<std::byte> content(64);
  content[0] = std::byte{1};
  for (std::size_t i = 1; i < 5; ++i) content[i] = std::byte{0xFF};
  EXPECT_FALSE(decode_points(compress(content)));
  EXPECT_FALSE(decode_features(compress(content)));
}

TEST(FeatureCodec, PlacesAreMadeOfThemAsOfTheOriginals) {
  const Keyframe keyframe = test::sample_keyframe(3, 100, 1200);
  const auto back = decode_features(encode_features(keyframe.features));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->size(), PlaceOptions{}.most_keypoints);
  Keyframe restored = keyframe;
  restored.features = *back;
  const Place was = make_place(keyframe);
  const Place is = make_place(restored);
  EXPECT_TRUE(std::ranges::equal(is.descriptors, was.descriptors));
  EXPECT_TRUE(std::ranges::equal(is.keypoints_m, was.keypoints_m));
}

TEST(FeatureCodec, KeypointsComeBackAsTheyWere) {
  const Features features = test::sample_keyframe(4, 0, 30).features;
  const auto back = decode_features(encode_features(features));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    EXPECT_EQ(back->keypoints[i].u_px, features.keypoints[i].u_px);
    EXPECT_EQ(back->keypoints[i].v_px, features.keypoints[i].v_px);
    EXPECT_EQ(back->keypoints[i].angle_rad, features.keypoints[i].angle_rad);
    EXPECT_EQ(back->keypoints[i].octave, features.keypoints[i].octave);
    EXPECT_EQ(back->keypoints[i].response, features.keypoints[i].response);
  }
}

TEST(FeatureCodec, DamageIsSeen) {
  expect_damage_is_seen(encode_features(test::sample_keyframe(1, 0, 3).features), &decode_features,
                        &encode_features);
}

TEST(ValueCodec, APoseThatIsNoneIsRefused) {
  PoseBytes bytes = encode_pose(test::sample_map_pose(3));
  EXPECT_TRUE(decode_pose(bytes));
  EXPECT_FALSE(decode_pose(std::span(bytes).first(48)));
  Pose broken = test::sample_map_pose(3);
  broken.translation_m.x() = std::nan("");
  EXPECT_FALSE(decode_pose(encode_pose(broken)));
  broken = test::sample_map_pose(3);
  broken.rotation.coeffs() *= 1.1;
  EXPECT_FALSE(decode_pose(encode_pose(broken)));
}

TEST(WordsCodec, WordsComeBackAndWhatIsNoBagIsRefused) {
  const BagOfWords words = {{3, 0.25F}, {70000, 0.5F}, {70001, 0.25F}};
  const auto back = decode_words(encode_words(words));
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), 3U);
  EXPECT_EQ((*back)[1].word, 70000U);
  EXPECT_EQ((*back)[1].weight, 0.5F);
  ASSERT_TRUE(decode_words({}));
  EXPECT_TRUE(decode_words({})->empty());
  const std::vector<std::byte> bytes = encode_words(words);
  EXPECT_FALSE(decode_words(std::span(bytes).first(bytes.size() - 1)));
  EXPECT_FALSE(decode_words(encode_words({{3, 0.5F}, {3, 0.5F}})));
  EXPECT_FALSE(decode_words(encode_words({{4, 0.5F}, {3, 0.5F}})));
  EXPECT_FALSE(decode_words(encode_words({{3, std::numeric_limits<float>::quiet_NaN()}})));
  EXPECT_FALSE(decode_words(encode_words({{3, -1.0F}})));
}

}  // namespace
}  // namespace glint::slam
