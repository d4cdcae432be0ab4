// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/record/capture_parts.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "driver/core/error.hpp"
#include "pcap/capture_reader.hpp"
#include "pcap/test_capture.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPayloadBytes = 1000;
constexpr std::size_t kRecordBytes = 16 + 14 + 20 + 8 + kPayloadBytes;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class CapturePartsTest : public testing::Test {
 protected:
  static void write(CaptureParts& parts, int count) {
    const std::vector<std::byte> payload(kPayloadBytes);
    for (int i = 0; i < count; ++i) {
      parts.write({1'700'000'000'000'000'000}, glint::test::sender(), glint::test::receiver(),
                  payload);
    }
  }
  static int datagrams(const fs::path& file) {
    CaptureReader reader(file);
    int count = 0;
    while (reader.next() != nullptr) ++count;
    return count;
  }

  const glint::test::TempDir dir_;
  const fs::path file_ = dir_ / "drive.pcap";
};

TEST_F(CapturePartsTest, OneFileHasItsNameAndMetadataBeside) {
  CaptureParts parts({file_, 0, 0}, "{\"a\":1}");
  write(parts, 5);
  parts.flush();
  EXPECT_EQ(datagrams(file_), 5) << "before it is finished";
  EXPECT_EQ(text_of(dir_ / "drive.json"), "{\"a\":1}");
  parts.finish();
  EXPECT_EQ(parts.bytes(), fs::file_size(file_));
}

TEST_F(CapturePartsTest, PartsFollowEachOtherWithMetadataEach) {
  CaptureParts parts({file_, 4 * kRecordBytes, 0}, "{}");
  write(parts, 10);
  parts.finish();
  EXPECT_EQ(parts.files(), 3U);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_EQ(datagrams(dir_ / "drive_0001.pcap"), 4);
  EXPECT_EQ(datagrams(dir_ / "drive_0002.pcap"), 4);
  EXPECT_EQ(datagrams(dir_ / "drive_0003.pcap"), 2);
  EXPECT_EQ(text_of(dir_ / "drive_0003.json"), "{}");
}

TEST_F(CapturePartsTest, TheOldestPartsGoWhenAllWouldBeTooLarge) {
  CaptureParts parts({file_, 4 * kRecordBytes, 13 * kRecordBytes}, "{}");
  write(parts, 30);
  parts.finish();
  EXPECT_EQ(parts.files(), 8U);
  EXPECT_EQ(parts.deleted_files(), 5U);
  EXPECT_LE(parts.bytes(), 13 * kRecordBytes);
  EXPECT_FALSE(fs::exists(dir_ / "drive_0005.pcap"));
  EXPECT_FALSE(fs::exists(dir_ / "drive_0005.json"));
  EXPECT_EQ(datagrams(dir_ / "drive_0006.pcap"), 4);
  EXPECT_EQ(datagrams(dir_ / "drive_0008.pcap"), 2);
}

TEST_F(CapturePartsTest, NewMetadataBeginAPart) {
  CaptureParts parts({file_, 100 * kRecordBytes, 0}, "old");
  write(parts, 1);
  parts.set_metadata("new");
  write(parts, 2);
  parts.finish();
  EXPECT_EQ(text_of(dir_ / "drive_0001.json"), "old");
  EXPECT_EQ(text_of(dir_ / "drive_0002.json"), "new");
  EXPECT_EQ(datagrams(dir_ / "drive_0002.pcap"), 2);
}

TEST_F(CapturePartsTest, NothingIsWrittenOver) {
  glint::test::save(file_, {1, 2, 3});
  EXPECT_THROW(CaptureParts({file_, 0, 0}, "{}"), InputError);
  EXPECT_EQ(fs::file_size(file_), 3U);
}

}  // namespace
}  // namespace glint::daemon
