// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/albedo_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pcap/synth/paint/materials.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

constexpr double kTexelM = 0.01;
constexpr double kSideM = 0.64;

Canvas repeating(double albedo = 0.5) {
  return Canvas(kSideM, kSideM, kTexelM, albedo, Edges::kRepeat);
}

double texel(const Canvas& canvas, int x, int y) {
  return canvas.texels()[static_cast<std::size_t>(y * canvas.columns() + x)];
}

TEST(Canvas, ThatRepeatsIsRoundedUpToAPowerOfTwo) {
  const Canvas canvas(1.0, 0.3, kTexelM, 0.5, Edges::kRepeat);
  EXPECT_EQ(canvas.columns(), 128);
  EXPECT_EQ(canvas.rows(), 32);
}

TEST(Canvas, ThatRepeatsShowsOnTheOtherSideWhatIsDrawnOverAnEdge) {
  Canvas canvas = repeating(0.0);
  canvas.disc(0.0, 0.0, 0.05, 1.0);
  for (const int x : {0, 63}) {
    for (const int y : {0, 63}) EXPECT_EQ(texel(canvas, x, y), 1.0) << x << " " << y;
  }
  EXPECT_EQ(texel(canvas, 32, 0), 0.0);
  Canvas ends(kSideM, kSideM, kTexelM, 0.0);
  ends.disc(0.0, 0.0, 0.05, 1.0);
  EXPECT_EQ(texel(ends, 0, 0), 1.0);
  EXPECT_EQ(texel(ends, 63, 0), 0.0);
}

TEST(Canvas, NoiseHasNoSeamWhereItRepeats) {
  Canvas canvas = repeating();
  canvas.blotch(canvas.whole(), 0.1, 0.8, 7);
  double inside = 0.0;
  double seam = 0.0;
  for (int i = 0; i < 64; ++i) {
    for (int k = 0; k + 1 < 64; ++k) {
      inside = std::max(inside, std::abs(texel(canvas, k + 1, i) - texel(canvas, k, i)));
    }
    seam = std::max(seam, std::abs(texel(canvas, 0, i) - texel(canvas, 63, i)));
    seam = std::max(seam, std::abs(texel(canvas, i, 0) - texel(canvas, i, 63)));
  }
  EXPECT_GT(inside, 0.02);
  EXPECT_LT(seam, 1.5 * inside);
}

TEST(Canvas, NoiseOfAPartIsThatOfTheWhole) {
  Canvas whole(kSideM, kSideM, kTexelM, 0.5);
  Canvas part = whole;
  whole.blotch(whole.whole(), 0.07, 0.5, 3);
  part.blotch({0.2, 0.1, 0.3, 0.3}, 0.07, 0.5, 3);
  EXPECT_NEAR(texel(part, 30, 20), texel(whole, 30, 20), 1e-5);
  EXPECT_NE(texel(whole, 30, 20), 0.5);
  EXPECT_EQ(texel(part, 10, 20), 0.5);
}

TEST(AlbedoMap, ThatRepeatsComesAgainInBothDirectionsForBeamsOfEveryWidth) {
  Canvas canvas = repeating();
  Random random{5};
  canvas.paint(canvas.whole(), [&](double, double) { return random.uniform(); });
  const AlbedoMap map(canvas);
  for (const double footprint_m : {0.0, 0.01, 0.03, 0.1, 0.3, 5.0}) {
    for (int i = 0; i < 50; ++i) {
      const double u = random.uniform(0.0, kSideM);
      const double v = random.uniform(0.0, kSideM);
      const double here = map.sample(u, v, footprint_m);
      EXPECT_NEAR(map.sample(u + 3 * kSideM, v, footprint_m), here, 1e-9);
      EXPECT_NEAR(map.sample(u - 2 * kSideM, v + 5 * kSideM, footprint_m), here, 1e-9);
    }
  }
}

TEST(AlbedoMap, ThatRepeatsIsMixedAcrossItsSeam) {
  Canvas canvas = repeating(0.0);
  canvas.fill({0.0, 0.0, 0.32, kSideM}, 1.0);
  const AlbedoMap map(canvas);
  EXPECT_NEAR(map.sample(0.0, 0.3, 0.0), 0.5, 0.01);
  EXPECT_NEAR(map.sample(kSideM + 0.16, 0.3, 0.0), 1.0, 0.01);
  // So wide a beam sees as much of the one side as of the other.
  EXPECT_NEAR(map.sample(0.0, 0.3, 0.16), 0.5, 0.01);
}

TEST(AlbedoMap, ThatDoesNotRepeatGoesOnAsItsEdge) {
  Canvas canvas(kSideM, kSideM, kTexelM, 0.2);
  canvas.fill({0.32, 0.0, 0.32, kSideM}, 0.8);
  const AlbedoMap map(canvas);
  EXPECT_NEAR(map.sample(-9.0, 0.3, 0.01), 0.2, 0.01);
  EXPECT_NEAR(map.sample(9.0, 0.3, 0.01), 0.8, 0.01);
}

TEST(AlbedoMap, AWideBeamSeesTheMeanOfAFineCheckerboard) {
  Canvas canvas = repeating();
  canvas.paint(canvas.whole(), [](double u, double v) {
    return (std::lround(u / kTexelM - 0.5) + std::lround(v / kTexelM - 0.5)) % 2 == 0 ? 1.0 : 0.0;
  });
  const AlbedoMap map(canvas);
  EXPECT_NEAR(map.sample(0.105, 0.205, 0.005), 0.0, 1.0);
  EXPECT_NEAR(map.sample(0.1, 0.2, 0.08), 0.5, 0.01);
}

struct Kind {
  Material material;
  double low;
  double high;
  double least_contrast;
};

class Materials : public testing::TestWithParam<Kind> {};

TEST_P(Materials, AreAsBrightAsTheRealOnesVariedAndEachDifferent) {
  const Kind kind = GetParam();
  Random random{9, static_cast<std::uint64_t>(kind.material)};
  const auto first = make_material(kind.material, random);
  const auto second = make_material(kind.material, random);
  double sum = 0.0;
  double squares = 0.0;
  double apart = 0.0;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform(0.0, 30.0);
    const double v = random.uniform(0.0, 30.0);
    const double here = first->sample(u, v, 0.03);
    sum += here;
    squares += here * here;
    apart += std::abs(here - second->sample(u, v, 0.03));
  }
  const double mean = sum / kCount;
  EXPECT_GT(mean, kind.low);
  EXPECT_LT(mean, kind.high);
  EXPECT_GT(std::sqrt(squares / kCount - mean * mean) / mean, kind.least_contrast);
  EXPECT_GT(apart / kCount, 0.02 * mean);
}

INSTANTIATE_TEST_SUITE_P(
    All, Materials,
    testing::Values(
        Kind{Material::kAsphalt, 0.08, 0.25, 0.06}, Kind{Material::kPaving, 0.2, 0.5, 0.08},
        Kind{Material::kGrass, 0.25, 0.5, 0.1}, Kind{Material::kEarth, 0.12, 0.35, 0.1},
        Kind{Material::kConcrete, 0.25, 0.5, 0.06}, Kind{Material::kPlaster, 0.3, 0.8, 0.04},
        Kind{Material::kBrick, 0.15, 0.6, 0.08}, Kind{Material::kRoof, 0.1, 0.45, 0.08},
        Kind{Material::kWood, 0.2, 0.6, 0.08}, Kind{Material::kMetal, 0.15, 0.65, 0.04},
        Kind{Material::kBark, 0.1, 0.45, 0.12}, Kind{Material::kLeaves, 0.25, 0.55, 0.12},
        Kind{Material::kRock, 0.15, 0.5, 0.1}, Kind{Material::kRoadPaint, 0.4, 0.75, 0.06},
        Kind{Material::kCloth, 0.05, 0.75, 0.05}));

}  // namespace
}  // namespace glint::synth
