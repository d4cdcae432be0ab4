// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gmock/gmock.h>

#include <functional>
#include <random>

#include "driver/core/error.hpp"
#include "pcap/recording/flat_table.hpp"
#include "pcap/recording/fuzz_recording.hpp"
#include "pcap/recording/osf_file.hpp"
#include "pcap/recording/test_recording.hpp"
#include "pcap/test_capture.hpp"

namespace glint::recording {
namespace {

using test::Buffer;
using test::TestMessage;
using test::WriteOptions;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<TestMessage> random_packets(std::size_t count) {
  std::mt19937 random(3);
  std::vector<TestMessage> messages(count);
  for (std::size_t i = 0; i < count; ++i) {
    Buffer body(600 + random() % 100);
    for (std::byte& byte : body) byte = static_cast<std::byte>(random());
    messages[i] = {TestMessage::Kind::kPacket, "/ouster/lidar_packets",
                   static_cast<std::int64_t>(i), std::move(body)};
  }
  return messages;
}

struct Kind {
  std::string name;
  std::function<Buffer(const std::vector<TestMessage>&)> write;
  friend std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }
};

Buffer sqlite_bytes(const std::vector<TestMessage>& messages) {
  const glint::test::TempDir dir;
  test::write_sqlite(dir / "x", messages);
  return test::load_file(dir / "x");
}

class Damaged : public ::testing::TestWithParam<Kind> {
 protected:
  /// What of the file can be read; nothing if it is refused.
  std::vector<TestMessage> read(const Buffer& bytes, std::string* problem = nullptr) {
    test::save(dir_ / "recording", bytes);
    try {
      return test::read_messages(dir_ / "recording", problem);
    } catch (const InputError& error) {
      if (problem != nullptr) *problem = error.what();
      return {};
    }
  }
  const glint::test::TempDir dir_;
};

TEST_P(Damaged, CutAtAnyByteLosesOnlyTheTail) {
  const std::vector<TestMessage> messages = random_packets(60);
  const Buffer whole = GetParam().write(messages);
  std::size_t before = 0;
  for (std::size_t size = 0; size < whole.size(); size += 397) {
    std::string problem;
    const auto read =
        this->read(Buffer(whole.begin(), whole.begin() + static_cast<long>(size)), &problem);
    ASSERT_LE(read.size(), messages.size());
    ASSERT_TRUE(std::equal(read.begin(), read.end(), messages.begin())) << size;
    // SQLite writes the pages of its index in between, so what is left need not grow with each.
    if (!GetParam().name.starts_with("Sqlite")) {
      ASSERT_GE(read.size(), before) << size;
    }
    ASSERT_TRUE(read.size() == messages.size() || !problem.empty()) << size;
    before = read.size();
  }
  // Of a cut near the end, nearly all is left, unless all was packed in one.
  if (GetParam().name == "Zstd") return;
  EXPECT_GE(read(Buffer(whole.begin(), whole.end() - 5000)).size(), 40U);
}

TEST_P(Damaged, WrongBytesAnywhereAreSurvived) {
  const Buffer whole = GetParam().write(random_packets(20));
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    Buffer bytes = whole;
    for (int flips = 0; flips < 3; ++flips) {
      // Mostly where the structure is dense.
      const std::size_t range = random() % 2 == 0 ? bytes.size() : std::size_t{300};
      const std::size_t at =
          random() % 2 == 0 ? random() % range : bytes.size() - 1 - random() % range;
      bytes[at] = static_cast<std::byte>(random());
    }
    EXPECT_LE(read(bytes).size(), 40U);
  }
}

TEST_P(Damaged, FuzzEntryReturnsFromAnything) {
  Buffer bytes = GetParam().write(random_packets(3));
  for (std::size_t size = 0; size <= bytes.size(); size += bytes.size() / 9) {
    fuzz_recording(ByteSpan(bytes).first(size));
  }
  std::ranges::fill(bytes, std::byte{0xFF});
  fuzz_recording(bytes);
}

Kind ros1_kind(const std::string& name, const WriteOptions& options) {
  return {"Ros1" + name, [options](const auto& m) { return test::ros1_bag(m, options); }};
}
Kind mcap_kind(const std::string& name, const WriteOptions& options) {
  return {"Mcap" + name, [options](const auto& m) { return test::mcap(m, options); }};
}

INSTANTIATE_TEST_SUITE_P(
    Formats, Damaged,
    ::testing::Values(
        ros1_kind("", {}), ros1_kind("Bzip2", {.compression = Compression::kBzip2}),
        ros1_kind("Lz4", {.compression = Compression::kLz4}), mcap_kind("", {}),
        mcap_kind("Lz4", {.compression = Compression::kLz4}),
        mcap_kind("Zstd", {.compression = Compression::kZstd}),
        mcap_kind("Unchunked", {.messages_per_chunk = 0}), Kind{"Sqlite", sqlite_bytes},
        Kind{"Zstd",
             [](const auto& m) { return test::compress(Compression::kZstd, test::mcap(m)); }}),
    [](const auto& test) { return test.param.name; });

class Damage : public Damaged {};

TEST_F(Damage, ChunkThatIsDamagedCostsNoOther) {
  for (const Compression compression : {Compression::kLz4, Compression::kBzip2}) {
    const std::vector<TestMessage> messages = random_packets(30);
    Buffer bytes = test::ros1_bag(messages, {compression, 10});
    // In the middle of the second of three.
    for (std::size_t i = 0; i < 50; ++i) bytes[bytes.size() / 2 + 2000 + i] ^= std::byte{0x55};
    std::string problem;
    const auto read = this->read(bytes, &problem);
    ASSERT_THAT(read, SizeIs(20));
    EXPECT_EQ(read.back(), messages.back());
    EXPECT_THAT(problem, HasSubstr("1 chunks of the recording"));
  }
}

TEST_F(Damage, UnfinishedBagIsReadWholeAndSaysSo) {
  const std::vector<TestMessage> messages = random_packets(20);
  for (const Buffer& bytes :
       {test::ros1_bag(messages, {.finished = false}), test::mcap(messages, {.finished = false})}) {
    std::string problem;
    EXPECT_EQ(read(bytes, &problem), messages);
    EXPECT_THAT(problem, HasSubstr("never finished"));
  }
}

/// A ROS 1 recorder writes a chunk's size when it closes the chunk, so the last one's is zero.
TEST_F(Damage, ChunkThatWasNeverClosedIsRead) {
  const std::vector<TestMessage> messages = random_packets(10);
  for (const Compression compression : {Compression::kNone, Compression::kLz4}) {
    const WriteOptions options{compression, 100, false};
    Buffer bytes = test::ros1_bag(messages, options);
    const std::string name = "compression=";
    const auto at = test::to_string(bytes).find(name) + name.size();
    const std::size_t value_bytes = compression == Compression::kNone ? 4 : 3;
    // Behind it: the field of the unpacked size, and the size of the data.
    for (std::size_t i = 0; i < 4; ++i) bytes[at + value_bytes + 4 + 5 + 4 + i] = std::byte{0};
    bytes.erase(bytes.end() - 40, bytes.end());  // The index that follows a closed chunk.
    EXPECT_THAT(read(bytes), ::testing::ContainerEq(messages));
  }
}

TEST_F(Damage, BombsGoOffInABox) {
  const Buffer frame = test::compress(Compression::kZstd, Buffer(std::size_t{16} << 20U));
  test::ByteWriter bomb;
  for (int i = 0; i < 20; ++i) bomb.bytes(frame);
  const Inflated inflated = Inflater().inflate(Compression::kZstd, bomb.buffer());
  EXPECT_FALSE(inflated.whole);

  std::string problem;
  EXPECT_THAT(read(bomb.buffer(), &problem), IsEmpty());
  EXPECT_THAT(problem, HasSubstr("no recording"));
}

TEST_F(Damage, AllChunksTogetherMayUnpackToAboutAThousandTimesTheirSize) {
  const Buffer packed = test::compress(Compression::kZstd, Buffer(std::size_t{64} << 20U));
  Inflater inflater;
  std::uint64_t unpacked = 0;
  for (int i = 0; i < 30; ++i)
    unpacked += inflater.inflate(Compression::kZstd, packed).bytes.size();
  EXPECT_LE(unpacked, (1ULL << 30U) + std::size_t{80'000} * packed.size());
  EXPECT_GE(unpacked, 1ULL << 30U);
  EXPECT_FALSE(inflater.inflate(Compression::kZstd, packed).whole);
}

TEST_F(Damage, SizesThatLieTakeNoMemory) {
  const auto huge = test::ByteWriter()
                        .text("\x89MCAP0\r\n")
                        .integer(std::uint8_t{6})
                        .integer(std::uint64_t{200} << 20U)
                        .bytes(Buffer(64))
                        .buffer();
  std::string problem;
  EXPECT_THAT(read(huge, &problem), IsEmpty());
  EXPECT_THAT(problem, HasSubstr("breaks off"));
}

TEST_F(Damage, DatabaseOfAnotherPurposeOrWithAViewInPlaceOfATableIsRefused) {
  std::string problem;
  Buffer bytes = sqlite_bytes(random_packets(3));
  const std::string text = test::to_string(bytes);
  const std::string name = "messagesmessages";
  ASSERT_NE(text.find(name), std::string::npos);
  bytes[text.find(name)] = std::byte{'M'};
  EXPECT_THAT(read(bytes, &problem), IsEmpty());
  EXPECT_THAT(problem, HasSubstr("no tables of topics and messages"));
}

TEST_F(Damage, OsfThatIsCutShortOrDamagedGivesTheRightMetadataOrNone) {
  const std::string json = "{\"prod_line\": \"OS-1-64\"}";
  const Buffer whole = test::osf({json, "{}"});
  std::mt19937 random(7);
  const auto metadata = [this](const Buffer& bytes) {
    test::save(dir_ / "x.osf", bytes);
    const std::optional<OsfContents> contents = read_osf(dir_ / "x.osf");
    return contents ? contents->sensor : std::nullopt;
  };
  EXPECT_EQ(metadata(whole), json);
  for (std::size_t size = 0; size < whole.size(); size += 3) {
    const Buffer part(whole.begin(), whole.begin() + static_cast<long>(size));
    EXPECT_EQ(metadata(part), std::nullopt) << size;
  }
  for (int i = 0; i < 400; ++i) {
    Buffer bytes = whole;
    bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    EXPECT_EQ(metadata(bytes).value_or(json), json) << i;
  }
}

TEST_F(Damage, OsfMetadataOfAnyBytesIsReadWithinBounds) {
  const Buffer whole = test::osf_metadata({"{\"prod_line\": \"OS-1-64\"}", "{}"});
  std::mt19937 random(8);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // With its size put right, so that the end of the bytes is met further in.
    Buffer part(whole.begin(), whole.begin() + static_cast<long>(size));
    if (size >= 4) {
      const Buffer prefix =
          test::ByteWriter().integer(static_cast<std::uint32_t>(size - 4)).buffer();
      std::copy(prefix.begin(), prefix.end(), part.begin());
    }
    parse_osf_metadata(part);
  }
  for (int i = 0; i < 4000; ++i) {
    Buffer bytes = whole;
    for (int n = 0; n < 3; ++n) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    parse_osf_metadata(bytes);
  }
}

}  // namespace
}  // namespace glint::recording
