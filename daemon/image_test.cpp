// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// get_image.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <thread>

#include "daemon/base64.hpp"
#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using test::TestDaemon;

/// Width, height and the number of pixels that are not black.
struct DecodedPng {
  int rows = 0;
  int cols = 0;
  std::size_t bright = 0;
};

DecodedPng decode(const Json& image) {
  const auto bytes = base64_decode(image["png"].get<std::string>()).value();
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0);
  png.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  EXPECT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0);
  const auto black = std::count(pixels.begin(), pixels.end(), std::uint8_t{0});
  return {static_cast<int>(png.height), static_cast<int>(png.width),
          pixels.size() - static_cast<std::size_t>(black)};
}

TEST(ImageTest, TheLatestScanIsShownAsPng) {
  TestDaemon daemon;
  const auto packets = test::room_packets(daemon.info(), 40);
  // Nothing is kept before somebody asks: the scans come while the first question waits.
  std::jthread feeder([&](const std::stop_token& stop) {
    for (const auto& packet : packets) {
      if (stop.stop_requested()) return;
      daemon.source().feed(packet);
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
  });
  Client client(daemon.address());
  for (const char* kind : {"range", "signal", "filtered"}) {
    const Json image = client.call("get_image", {{"kind", kind}});
    EXPECT_EQ(image["kind"], kind);
    const DecodedPng png = decode(image);
    EXPECT_EQ(png.rows, daemon.info().pixels_per_column) << kind;
    EXPECT_EQ(png.cols, daemon.info().columns_per_frame) << kind;
    EXPECT_EQ(png.rows, image["rows"]);
    EXPECT_GT(png.bright, static_cast<std::size_t>(png.rows * png.cols / 2)) << kind;
  }
}

TEST(ImageTest, WithoutAScanThereIsNone) {
  TestDaemon daemon;
  Client client(daemon.address());
  try {
    client.call("get_image");
    FAIL() << "an image of nothing";
  } catch (const ReplyError& error) {
    EXPECT_EQ(error.error()["data"]["code"], "NOT_TRACKING");
  }
}

TEST(ImageTest, UnknownKindsAreNamed) {
  TestDaemon daemon;
  Client client(daemon.address());
  try {
    client.call("get_image", {{"kind", "xray"}});
    FAIL();
  } catch (const ReplyError& error) {
    EXPECT_EQ(error.error()["data"]["field"], "kind");
  }
}

}  // namespace
}  // namespace glint::daemon
