// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <random>

#include "driver/core/error.hpp"
#include "pcap/recording/crc32.hpp"
#include "pcap/recording/osf_file.hpp"
#include "pcap/recording/recording_files.hpp"
#include "pcap/recording/recording_format.hpp"
#include "pcap/recording/recording_metadata.hpp"
#include "pcap/recording/test_recording.hpp"
#include "pcap/test_capture.hpp"

namespace glint::recording {
namespace {

using test::TestMessage;
using test::WriteOptions;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Messages of all kinds in random order and of random sizes, with texts long and short.
std::vector<TestMessage> random_messages(int count) {
  std::mt19937 random(1);
  std::vector<TestMessage> messages;
  std::int64_t time_ns = 1'700'000'000'000'000'000;
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<TestMessage::Kind>(random() % 3);
    const std::string topic = kind == TestMessage::Kind::kPacket ? "/ouster/lidar_packets"
                              : kind == TestMessage::Kind::kText ? "/ouster/metadata"
                                                                 : "/points";
    test::Buffer body(random() % 2000);
    for (std::byte& byte : body) byte = static_cast<std::byte>(random() % 7 + 'a');
    time_ns += static_cast<std::int64_t>(random() % 3'000'000);
    messages.push_back({kind, topic, time_ns, std::move(body)});
  }
  return messages;
}

/// What can be read back: the contents of messages of no interest are left alone.
std::vector<TestMessage> without_other_bodies(std::vector<TestMessage> messages) {
  for (TestMessage& message : messages) {
    if (message.kind == TestMessage::Kind::kOther) message.body.clear();
  }
  return messages;
}

struct Container {
  std::string name;
  std::function<void(const std::filesystem::path&, const std::vector<TestMessage>&)> write;
  friend std::ostream& operator<<(std::ostream& out, const Container& c) { return out << c.name; }
};

Container ros1(const std::string& name, const WriteOptions& options) {
  return {"Ros1" + name, [options](const auto& file, const auto& messages) {
            test::save(file, test::ros1_bag(messages, options));
          }};
}

Container mcap(const std::string& name, const WriteOptions& options) {
  return {"Mcap" + name, [options](const auto& file, const auto& messages) {
            test::save(file, test::mcap(messages, options));
          }};
}

Container sqlite(const std::string& name, const WriteOptions& options) {
  return {"Sqlite" + name, [options](const auto& file, const auto& messages) {
            test::write_sqlite(file, messages, options);
          }};
}

Container packed(const Container& inner) {
  return {inner.name + "File", [inner](const auto& file, const auto& messages) {
            inner.write(file, messages);
            test::save(file, test::compress(Compression::kZstd, test::load_file(file)));
          }};
}

class EveryContainer : public ::testing::TestWithParam<Container> {
 protected:
  const glint::test::TempDir dir_;
};

TEST_P(EveryContainer, GivesBackWhatWentInInOrderAndWithItsTimes) {
  const std::vector<TestMessage> messages = random_messages(60);
  GetParam().write(dir_ / "recording", messages);
  ASSERT_TRUE(is_recording(dir_ / "recording"));
  std::string problem;
  EXPECT_EQ(test::read_messages(dir_ / "recording", &problem), without_other_bodies(messages));
  EXPECT_EQ(problem, "");
}

TEST_P(EveryContainer, WithoutMessagesIsReadToItsEnd) {
  GetParam().write(dir_ / "recording", {});
  std::string problem;
  EXPECT_THAT(test::read_messages(dir_ / "recording", &problem), IsEmpty());
  EXPECT_EQ(problem, "");
}

TEST_P(EveryContainer, HoldsMetadataThatIsFound) {
  const auto text = [](const char* topic, const char* json) {
    return TestMessage{TestMessage::Kind::kText, topic, 5, test::to_bytes(json)};
  };
  GetParam().write(dir_ / "recording",
                   {text("/chatter", "{}"), text("/a/metadata", "no JSON"),
                    text("/b/metadata", " {\"b\": 1}"), text("/c/metadata", "{\"c\": 1}")});
  EXPECT_EQ(find_metadata(dir_ / "recording"), " {\"b\": 1}");
  EXPECT_EQ(find_metadata(dir_ / "recording", "/c/"), "{\"c\": 1}");
  EXPECT_EQ(find_metadata(dir_ / "recording", "/d/"), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, EveryContainer,
    ::testing::Values(ros1("", {}), ros1("Bzip2", {.compression = Compression::kBzip2}),
                      ros1("Lz4", {.compression = Compression::kLz4}), packed(ros1("", {})),
                      mcap("", {}), mcap("Lz4", {.compression = Compression::kLz4}),
                      mcap("Zstd", {.compression = Compression::kZstd}),
                      mcap("Unchunked", {.messages_per_chunk = 0}),
                      mcap("PackedMessages", {.pack_messages = true}), packed(mcap("", {})),
                      sqlite("", {}), sqlite("BigEndian", {.big_endian = true}),
                      sqlite("PackedMessages", {.pack_messages = true}), packed(sqlite("", {}))),
    [](const auto& test) { return test.param.name; });

class Formats : public ::testing::Test {
 protected:
  static std::string complaint(const std::filesystem::path& path) {
    try {
      test::read_messages(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }
  const glint::test::TempDir dir_;
};

TEST_F(Formats, LogOfARecorderThatDiedIsReadWithTheDatabase) {
  const std::vector<TestMessage> messages = random_messages(20);
  test::write_sqlite(dir_ / "bag.db3", messages, {.finished = false});
  ASSERT_GT(std::filesystem::file_size(dir_ / "bag.db3-wal"), 0U);
  EXPECT_EQ(test::read_messages(dir_ / "bag.db3"), without_other_bodies(messages));
}

TEST_F(Formats, DatabaseInAReadOnlyFolderIsReadAndNothingIsMadeBesideIt) {
  test::write_sqlite(dir_ / "bag #1?.db3", random_messages(5));
  test::read_messages(dir_ / "bag #1?.db3");
  const std::filesystem::directory_iterator entries((dir_ / "x").parent_path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST_F(Formats, PartsOfABagAreReadInTheOrderThatItsMetadataLists) {
  const std::vector<TestMessage> messages = random_messages(9);
  test::write_sqlite(dir_ / "b.db3", {messages.begin(), messages.begin() + 3});
  test::save(dir_ / "c.mcap", test::mcap({messages.begin() + 3, messages.begin() + 6}));
  test::write_sqlite(dir_ / "a.db3", {messages.begin() + 6, messages.end()});
  test::write_sqlite(dir_ / "stray.db3", messages);
  std::ofstream(dir_ / "metadata.yaml") << "rosbag2_bagfile_information:\n"
                                           "  version: 4\n"
                                           "  relative_file_paths:\n"
                                           "    - b.db3\n"
                                           "    - \"folder/c.mcap\"\n"
                                           "    - a.db3\n"
                                           "  duration:\n"
                                           "    - stray.db3\n";
  EXPECT_EQ(test::read_messages((dir_ / "x").parent_path()), without_other_bodies(messages));
}

TEST_F(Formats, PartsOfAFolderWithoutMetadataAreReadByNumber) {
  const std::vector<TestMessage> messages = random_messages(12);
  for (const int part : {0, 1, 2, 10}) {
    const auto first = messages.begin() + 3 * (part == 10 ? 3 : part);
    test::save(dir_ / ("bag_" + std::to_string(part) + ".bag"), test::ros1_bag({first, first + 3}));
  }
  std::ofstream(dir_ / "notes.txt") << "none of them\n";
  EXPECT_EQ(test::read_messages((dir_ / "x").parent_path()), without_other_bodies(messages));
}

TEST_F(Formats, PartThatIsDamagedIsToldOfAndTheOthersAreRead) {
  const std::vector<TestMessage> messages = random_messages(4);
  test::save(dir_ / "bag_0.db3", test::to_bytes("SQLite format 3"));
  test::save(dir_ / "bag_1.bag", test::ros1_bag(messages));
  std::string problem;
  EXPECT_EQ(test::read_messages((dir_ / "x").parent_path(), &problem),
            without_other_bodies(messages));
  EXPECT_THAT(problem, HasSubstr("bag_0.db3"));
}

TEST_F(Formats, OsfGivesItsFirstSensorsMetadata) {
  test::save(dir_ / "x.osf",
             test::osf({R"({"prod_line": "OS-1-64"})", R"({"prod_line": "OS-0"})"}));
  EXPECT_EQ(recording_format(dir_ / "x.osf"), RecordingFormat::kOsf);
  EXPECT_EQ(find_metadata(dir_ / "x.osf"), R"({"prod_line": "OS-1-64"})");
}

TEST_F(Formats, OsfSaysThatItHoldsNoPacketsWhatItHoldsAndTheWayOut) {
  test::save(dir_ / "x.osf", test::osf({"{}", "{}"}));
  EXPECT_THAT(
      complaint(dir_ / "x.osf"),
      AllOf(HasSubstr("no packets"), HasSubstr("2 LidarScanStream, 2 LidarSensor, 1 StreamingInfo"),
            HasSubstr("ouster-cli source")));
  test::save(dir_ / "packed", test::compress(Compression::kZstd, test::osf({"{}"})));
  EXPECT_THAT(complaint(dir_ / "packed"), HasSubstr("1 LidarSensor"));
}

/// To be asked for its metadata would lead a user astray.
TEST_F(Formats, OsfWithoutMetadataIsRefusedAtOnce) {
  test::save(dir_ / "unfinished.osf", test::osf({"{}"}, false));
  test::save(dir_ / "no_sensor.osf", test::osf({}));
  for (const char* name : {"unfinished.osf", "no_sensor.osf"}) {
    EXPECT_EQ(recording_format(dir_ / name), RecordingFormat::kOsf);
    EXPECT_THROW(find_metadata(dir_ / name), InputError);
  }
  EXPECT_THAT(complaint(dir_ / "unfinished.osf"), HasSubstr("never finished"));
}

TEST_F(Formats, OsfKindsOfUnusualLettersAreNotRepeated) {
  test::Buffer block = test::osf_metadata({"{}"});
  const std::size_t at = test::to_string(block).find("LidarScanStream");
  block[at] = std::byte{0x1B};
  const std::optional<OsfContents> contents = parse_osf_metadata(block);
  ASSERT_TRUE(contents);
  EXPECT_THAT(contents->kinds, ElementsAre("StreamingInfo", "LidarSensor"));
}

TEST(Crc32, IsThatOfItsCatalogue) {
  EXPECT_EQ(crc32({}), 0U);
  EXPECT_EQ(crc32(test::to_bytes("123456789")), 0xCBF4'3926U);
}

TEST_F(Formats, WhatIsNoRecordingIsRefusedWithTheReason) {
  test::save(dir_ / "text", test::to_bytes("some text that is no recording"));
  test::save(dir_ / "old.bag", test::to_bytes("#ROSRECORD V1.2\n"));
  EXPECT_FALSE(is_recording(dir_ / "text"));
  EXPECT_FALSE(is_recording(dir_ / "missing"));
  EXPECT_THAT(complaint(dir_ / "text"), HasSubstr("no recording"));
  EXPECT_THAT(complaint(dir_ / "old.bag"), HasSubstr("rosbag fix"));
  EXPECT_THAT(complaint((dir_ / "x").parent_path()), HasSubstr("rosbag fix"));
  std::filesystem::remove(dir_ / "old.bag");
  EXPECT_THAT(complaint((dir_ / "x").parent_path()), HasSubstr("no recording in the folder"));
}

}  // namespace
}  // namespace glint::recording
