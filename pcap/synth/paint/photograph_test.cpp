// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/photograph.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "driver/core/error.hpp"
#include "pcap/synth/paint/pictures.hpp"

namespace glint::synth {
namespace {

using namespace std::string_literals;

class PgmFile : public testing::Test {
 protected:
  ~PgmFile() override { std::filesystem::remove(path_); }

  Photograph load(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return load_pgm(path_);
  }
  // What loading complains of.
  std::string complaint(const std::string& bytes) {
    try {
      load(bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  }

  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("glint-photograph-" + std::to_string(getpid()) + ".pgm");
};

TEST_F(PgmFile, OfEightBitsIsReadRowByRowWithComments) {
  const Photograph p = load("P5 # grey\n#another\n3\t2\n255\n\x00\x01\x02\xFD\xFE\xFF"s);
  EXPECT_EQ(p.width, 3);
  EXPECT_EQ(p.height, 2);
  EXPECT_EQ(p.pixels, (std::vector<std::uint8_t>{0, 1, 2, 253, 254, 255}));
}

TEST_F(PgmFile, OfSixteenBitsIsReadHighByteFirstAndScaledToWhite) {
  EXPECT_EQ(load("P5 2 1 65535\n\x80\x00\xFF\xFF"s).pixels, (std::vector<std::uint8_t>{128, 255}));
  EXPECT_EQ(load("P5 2 1 1000\n\x01\xF4\xFF\xFF"s).pixels, (std::vector<std::uint8_t>{128, 255}));
}

TEST_F(PgmFile, WithALowerWhiteIsScaledToo) {
  EXPECT_EQ(load("P5 2 1 100\n\x32\x64"s).pixels, (std::vector<std::uint8_t>{128, 255}));
}

TEST_F(PgmFile, ThatIsNoneOrBrokenIsNamedWithItsCause) {
  const auto expect = [&](const std::string& bytes, const std::string& cause) {
    const std::string message = complaint(bytes);
    EXPECT_NE(message.find(path_.string()), std::string::npos) << message;
    EXPECT_NE(message.find(cause), std::string::npos) << message;
  };
  expect("", "does not begin with 'P5'");
  expect("P2 1 1 255\n0", "does not begin with 'P5'");
  expect("P5 2", "ends before its height");
  expect("P5 # no end", "ends before its width");
  expect("P5 x 2 255\n", "no number for its width");
  expect("P5 -3 2 255\n", "no number for its width");
  expect("P5 0 2 255\n", "width that is not between 1 and 8192");
  expect("P5 2 9000 255\n", "height that is not between 1 and 8192");
  expect("P5 99999999999999999999 2 255\n", "width that is not between 1 and 8192");
  expect("P5 1 1 65536\n\x01\x01", "white value that is not between 1 and 65535");
  expect("P5 1 1 255", "no blank after its white value");
  expect("P5 2 3 255\nabcde", "ends early: 2 of 3 rows are there");
  expect("P5 8192 8192 65535\n", "ends early: 0 of 8192 rows");
}

TEST_F(PgmFile, ThatIsMissingIsNamed) {
  try {
    load_pgm("/nowhere/cat.pgm");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'/nowhere/cat.pgm'"), std::string::npos);
  }
}

TEST(Photograph, HangsTheRightWayUpAndCutToItsFrame) {
  // Four wide, two high: dark below, bright above, with a white edge on either side to be cut off.
  const Photograph p{4, 2, {255, 204, 204, 255, 255, 51, 102, 255}};
  Canvas canvas(1.0, 1.0, 0.5, 0.0);
  draw_photograph(canvas, canvas.whole(), p);
  EXPECT_NEAR(canvas.texels()[0], 0.2, 1e-6);
  EXPECT_NEAR(canvas.texels()[1], 0.4, 1e-6);
  EXPECT_NEAR(canvas.texels()[2], 0.8, 1e-6);
  EXPECT_NEAR(canvas.texels()[3], 0.8, 1e-6);
}

TEST(Photograph, OfManyPixelsIsAveragedOverATexel) {
  Photograph p{64, 64, {}};
  for (int i = 0; i < 64 * 64; ++i) p.pixels.push_back((i + i / 64) % 2 == 0 ? 255 : 0);
  Canvas canvas(0.04, 0.04, 0.01, 0.0);
  draw_photograph(canvas, canvas.whole(), p);
  for (const float texel : canvas.texels()) EXPECT_NEAR(texel, 0.5, 0.01);
}

}  // namespace
}  // namespace glint::synth
