// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/vocabulary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/error.hpp"
#include "slam/loops/vocabulary_trainer.hpp"
#include "slam/matching.hpp"

namespace glint::slam {
namespace {

using ::testing::HasSubstr;
using Image = std::vector<Descriptor>;

Descriptor random_descriptor(std::mt19937_64& random) {
  Descriptor descriptor;
  for (auto& word : descriptor) word = random();
  return descriptor;
}

Descriptor with_flipped_bits(Descriptor descriptor, int bits, std::mt19937_64& random) {
  for (int i = 0; i < bits; ++i) {
    const std::uint64_t bit = random() % 256;
    descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

/// Images of a world with 300 things, each seen a little differently each time.
struct World {
  std::mt19937_64 random{1};
  std::vector<Descriptor> things;

  World() {
    for (int i = 0; i < 300; ++i) things.push_back(random_descriptor(random));
  }
  Image look(std::size_t first, std::size_t count) {
    Image image;
    for (std::size_t i = first; i < first + count; ++i) {
      image.push_back(with_flipped_bits(things[i % things.size()], 12, random));
    }
    return image;
  }
  std::vector<Image> walk() {
    std::vector<Image> images;
    for (std::size_t i = 0; i < 100; ++i) images.push_back(look(3 * i, 40));
    return images;
  }
};

Vocabulary small_vocabulary() {
  World world;
  return train_vocabulary(world.walk(), {.branching = 8, .depth = 3});
}

/// The bytes of a vocabulary, changed, with a checksum that is right again.
template <class Change>
std::vector<std::byte> forged(Change change) {
  std::vector<std::byte> bytes = small_vocabulary().bytes();
  bytes.resize(bytes.size() - 8);
  change(bytes);
  const std::uint64_t checksum = crc64(bytes);
  bytes.resize(bytes.size() + 8);
  store(&bytes[bytes.size() - 8], checksum);
  return bytes;
}

std::string refusal(const std::vector<std::byte>& bytes) {
  try {
    Vocabulary::parse(bytes, "words.glv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Vocabulary, SightsOfOneThingAreOneWordMostly) {
  World world;
  const Vocabulary vocabulary = train_vocabulary(world.walk(), {.branching = 8, .depth = 3});
  int same = 0;
  for (const Descriptor& thing : world.things) {
    const auto seen_again = with_flipped_bits(thing, 12, world.random);
    same += vocabulary.word_of(thing) == vocabulary.word_of(seen_again) ? 1 : 0;
  }
  EXPECT_GT(same, 240);
  std::set<std::uint32_t> words;
  for (const Descriptor& thing : world.things) words.insert(vocabulary.word_of(thing));
  EXPECT_GT(words.size(), 150U) << "things are told apart";
}

TEST(Vocabulary, SamePlaceIsMoreAlikeThanAnother) {
  World world;
  const Vocabulary vocabulary = train_vocabulary(world.walk(), {.branching = 8, .depth = 3});
  const BagOfWords here = vocabulary.bag_of(world.look(30, 40));
  const BagOfWords again = vocabulary.bag_of(world.look(32, 40));
  const BagOfWords elsewhere = vocabulary.bag_of(world.look(150, 40));
  EXPECT_GT(similarity(here, again), 0.6);
  EXPECT_LT(similarity(here, elsewhere), 0.15);
  EXPECT_NEAR(similarity(here, here), 1.0, 1e-5);
}

TEST(Vocabulary, SimilarityIsThatOfTheL1Norm) {
  const BagOfWords a = {{1, 0.5F}, {4, 0.25F}, {7, 0.25F}};
  const BagOfWords b = {{0, 0.125F}, {4, 0.5F}, {7, 0.125F}, {9, 0.25F}};
  // 1 - (0.125 + 0.5 + 0.25 + 0.125 + 0.25) / 2.
  EXPECT_DOUBLE_EQ(similarity(a, b), 0.375);
  EXPECT_DOUBLE_EQ(similarity(b, a), 0.375);
}

TEST(Vocabulary, WordsThatAllImagesHaveWeighNothing) {
  std::mt19937_64 random(3);
  const Descriptor everywhere = random_descriptor(random);
  const Descriptor rare = random_descriptor(random);
  const std::vector<Image> images = {{everywhere, rare}, {everywhere}, {everywhere}};
  const Vocabulary vocabulary = train_vocabulary(images);
  const BagOfWords bag = vocabulary.bag_of(images[0]);
  ASSERT_EQ(bag.size(), 1U);
  EXPECT_EQ(bag[0].word, vocabulary.word_of(rare));
  EXPECT_FLOAT_EQ(bag[0].weight, 1.0F);
  EXPECT_TRUE(vocabulary.bag_of(images[1]).empty());
  EXPECT_TRUE(vocabulary.bag_of({}).empty());
}

TEST(Vocabulary, TrainingRepeatsBitForBit) {
  EXPECT_EQ(small_vocabulary().bytes(), small_vocabulary().bytes());
}

TEST(Vocabulary, TrainingOnNothingIsRefused) {
  const std::vector<Image> nothing(3);
  EXPECT_THROW(train_vocabulary(nothing), InputError);
}

TEST(Vocabulary, ReadsWhatItWrote) {
  const Vocabulary written = small_vocabulary();
  const Vocabulary read = Vocabulary::parse(written.bytes(), "words.glv");
  EXPECT_EQ(read.hash(), written.hash());
  EXPECT_EQ(read.bytes(), written.bytes());
  World world;
  for (const Descriptor& thing : world.things) {
    ASSERT_EQ(read.word_of(thing), written.word_of(thing));
  }
  const auto bag = written.bag_of(world.things);
  EXPECT_NEAR(similarity(read.bag_of(world.things), bag), 1.0, 1e-5);
}

TEST(Vocabulary, AnyDamagedByteIsFound) {
  std::vector<std::byte> bytes = small_vocabulary().bytes();
  for (std::size_t i = 0; i < bytes.size(); i += 97) {
    bytes[i] ^= std::byte{0x10};
    EXPECT_THAT(refusal(bytes), HasSubstr("words.glv is")) << "byte " << i;
    bytes[i] ^= std::byte{0x10};
  }
  for (std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{27}, bytes.size() - 1}) {
    EXPECT_THAT(refusal({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}),
                HasSubstr("words.glv is"));
  }
}

TEST(Vocabulary, NodesThatAreNoTreeAreRefused) {
  constexpr std::size_t kNodes = 20;
  constexpr std::size_t kChildrenOfRoot = kNodes + 32;
  EXPECT_THAT(refusal(forged([](auto& bytes) { store(&bytes[16], std::uint32_t{0xFFFFFFFF}); })),
              HasSubstr("shorter than it says"));
  EXPECT_THAT(refusal(forged([](auto& bytes) { store(&bytes[8], std::uint32_t{2}); })),
              HasSubstr("of version 2"));
  for (const unsigned children : {0U, 1U, 63U, 255U}) {
    EXPECT_THAT(refusal(forged([&](auto& bytes) { bytes[kChildrenOfRoot] = std::byte(children); })),
                HasSubstr("its nodes are no tree"));
  }
  EXPECT_THAT(refusal(forged([](auto& bytes) { bytes.resize(bytes.size() - 2); })),
              HasSubstr("its nodes are no tree"));
  EXPECT_THAT(refusal(forged([](auto& bytes) { bytes.back() = std::byte{0xFF}; })),
              HasSubstr("too many images"));
}

TEST(Vocabulary, FileThatIsMissingIsNamed) {
  try {
    Vocabulary::load("/nowhere/words.glv");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/words.glv cannot be opened"));
  }
}

TEST(Vocabulary, OneIsBuiltIn) {
  const auto built_in = open_vocabulary({});
  EXPECT_GT(built_in->word_count(), 5000U);
  EXPECT_EQ(built_in, default_vocabulary());
  World world;
  EXPECT_GT(built_in->bag_of(world.things).size(), 100U);
}

}  // namespace
}  // namespace glint::slam
