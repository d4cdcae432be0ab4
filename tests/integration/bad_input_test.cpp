// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Whatever it is fed, `glint` says in a sentence what is wrong and what to do, with the exit code
// that programs rely on, and never crashes.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "driver/core/test_sensor.hpp"
#include "pcap/capture_writer.hpp"
#include "pcap/test_capture.hpp"
#include "tests/integration/glint_command.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_glint;
using ::testing::HasSubstr;

constexpr int kDone = 0;
constexpr int kUsage = 2;
constexpr int kBadInput = 3;
constexpr int kRows = 16;
constexpr int kColumns = 512;

class BadInputTest : public ::testing::Test {
 protected:
  BadInputTest() : info_(test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, kRows, kColumns)) {
    save_metadata(info_, meta_);
  }

  static void save_metadata(const SensorInfo& info, const fs::path& file) {
    std::ofstream(file) << to_metadata_json(info);
  }
  static void save_text(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  /// The packets of three scans.
  std::vector<test::Bytes> packets() {
    std::vector<test::Bytes> all;
    for (std::uint16_t frame = 1; frame <= 3; ++frame) {
      for (auto& packet : test::encode(info_, test::random_scan(info_, frame, random_))) {
        all.push_back(std::move(packet));
      }
    }
    return all;
  }
  void write_capture(const std::vector<test::Bytes>& all, int mtu = 0) const {
    CaptureWriter writer(capture_, {mtu});
    std::int64_t time_ns = 0;
    for (const test::Bytes& packet : all) {
      writer.write({time_ns += 1'000'000}, test::sender(), test::receiver(), packet);
    }
    writer.finish();
  }
  CommandResult dump() const {
    return run_glint({"dump", capture_, "--meta", meta_, "--out", out_});
  }
  /// The counters that the dump left in its index.
  nlohmann::json counters() const {
    return nlohmann::json::parse(std::ifstream(out_ / "index.json")).at("counters");
  }
  void expect_bad_input(const CommandResult& result, const std::string& named) const {
    EXPECT_EQ(result.exit_code, kBadInput) << result.out;
    EXPECT_THAT(result.out, HasSubstr(named));
    EXPECT_FALSE(fs::exists(out_ / "index.json"));
  }

  const test::TempDir dir_;
  const fs::path capture_ = dir_ / "capture.pcap";
  const fs::path meta_ = dir_ / "meta.json";
  const fs::path out_ = dir_ / "out";
  std::mt19937 random_{3};
  SensorInfo info_;
};

TEST_F(BadInputTest, GoodCaptureIsDumped) {
  write_capture(packets());
  const CommandResult result = dump();
  EXPECT_EQ(result.exit_code, kDone) << result.out;
  EXPECT_EQ(counters().at("assembler").at("scans"), 3);
  EXPECT_EQ(counters().at("assembler").at("incomplete_scans"), 0);
}

TEST_F(BadInputTest, MissingCaptureIsNamedByEveryCommand) {
  const std::string missing = dir_ / "missing.pcap";
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"dump", missing, "--meta", meta_, "--out", out_},
           {"info", missing},
           {"emulate", missing, "--meta", meta_, "--to", "127.0.0.1:9"},
           {"replay", missing, "--meta", meta_, "--out", out_}}) {
    const CommandResult result = run_glint(arguments);
    EXPECT_EQ(result.exit_code, kBadInput) << arguments[0] << ": " << result.out;
    EXPECT_THAT(result.out, HasSubstr("missing.pcap")) << arguments[0];
  }
}

TEST_F(BadInputTest, MissingMetadataSaysWhereItWasLookedFor) {
  write_capture(packets());
  expect_bad_input(run_glint({"dump", capture_, "--out", out_}), "capture.json");
  expect_bad_input(run_glint({"dump", capture_, "--meta", dir_ / "no.json", "--out", out_}),
                   "no.json");
}

TEST_F(BadInputTest, MetadataThatIsNoMetadataIsNamed) {
  write_capture(packets());
  for (const std::string& text : {std::string(), std::string("not JSON"), std::string("[1, 2]"),
                                  std::string("{}"), std::string(100'000, '[')}) {
    save_text(meta_, text);
    expect_bad_input(dump(), "meta.json");
  }
}

TEST_F(BadInputTest, EmptyCaptureIsCalledEmpty) {
  write_capture({});
  expect_bad_input(dump(), "empty");
}

TEST_F(BadInputTest, FileThatIsNoCaptureIsCalledSo) {
  save_text(capture_, "");
  expect_bad_input(dump(), "no pcap or pcapng capture");
  save_text(capture_, std::string(5000, 'x'));
  expect_bad_input(dump(), "no pcap or pcapng capture");
}

TEST_F(BadInputTest, MetadataOfAnotherSensorIsRefused) {
  write_capture(packets());
  save_metadata(test::make_sensor(LidarProfile::kLegacy, 64, 1024), meta_);
  expect_bad_input(dump(), "another sensor");
  SensorInfo twin = info_;
  twin.serial_number = "992137000142";
  save_metadata(twin, meta_);
  expect_bad_input(dump(), "992137000142");
}

TEST_F(BadInputTest, CutCaptureIsUsedAndReported) {
  write_capture(packets());
  fs::resize_file(capture_, fs::file_size(capture_) / 2);
  const CommandResult result = dump();
  EXPECT_EQ(result.exit_code, kDone) << result.out;
  EXPECT_THAT(result.out, HasSubstr("breaks off"));
  EXPECT_EQ(counters().at("assembler").at("scans"), 2);
}

TEST_F(BadInputTest, TruncatedAndForeignDatagramsAreCountedNotUsed) {
  auto all = packets();
  const std::size_t good = all.size();
  std::vector<test::Bytes> mixed;
  for (test::Bytes& packet : all) {
    test::Bytes cut(packet.begin(),
                    packet.begin() + static_cast<std::ptrdiff_t>(random_() % packet.size()));
    // What has the size of an IMU packet would be taken for one.
    if (cut.size() == kLegacyImuPacketBytes) cut.pop_back();
    mixed.push_back(std::move(cut));
    mixed.push_back(std::move(packet));
  }
  write_capture(mixed);
  const CommandResult result = dump();
  EXPECT_EQ(result.exit_code, kDone) << result.out;
  EXPECT_EQ(counters().at("source").at("wrong_size"), good);
  EXPECT_EQ(counters().at("assembler").at("packets"), good);
  EXPECT_EQ(counters().at("assembler").at("incomplete_scans"), 0);
}

TEST_F(BadInputTest, RandomBytesOfTheRightSizeDoNotCrash) {
  auto all = packets();
  for (std::size_t i = 0; i < all.size(); i += 3) {
    for (std::byte& b : all[i]) b = static_cast<std::byte>(random_());
  }
  write_capture(all);
  EXPECT_EQ(dump().exit_code, kDone);
}

TEST_F(BadInputTest, FlippedBitsInPacketsDoNotCrash) {
  for (int round = 0; round < 8; ++round) {
    auto all = packets();
    for (test::Bytes& packet : all) {
      // The headers, where a wrong value does most harm.
      for (int i = 0; i < 4; ++i) {
        packet[random_() % 48] ^= static_cast<std::byte>(1U << (random_() % 8));
      }
    }
    write_capture(all);
    const CommandResult result = dump();
    EXPECT_TRUE(result.exit_code == kDone || result.exit_code == kBadInput) << result.out;
  }
}

TEST_F(BadInputTest, FlippedBitsInTheFileDoNotCrash) {
  write_capture(packets(), 1500);
  std::ifstream in(capture_, std::ios::binary);
  const test::Buffer whole{std::istreambuf_iterator<char>(in), {}};
  for (int round = 0; round < 8; ++round) {
    test::Buffer damaged = whole;
    for (int i = 0; i < 100; ++i) {
      damaged[random_() % damaged.size()] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
    }
    test::save(capture_, damaged);
    const CommandResult result = dump();
    EXPECT_TRUE(result.exit_code == kDone || result.exit_code == kBadInput) << result.out;
    EXPECT_THAT(run_glint({"info", capture_}).exit_code, ::testing::AnyOf(kDone, kBadInput));
  }
}

TEST_F(BadInputTest, WrongUseIsToldFromBadInput) {
  write_capture(packets());
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {},
           {"dump", capture_},
           {"dump", capture_, "--meta", meta_, "--out", out_, "--frames", "3:1"},
           {"dump", capture_, "--meta", meta_, "--out", out_, "--source-ip", "nobody"},
           {"emulate", capture_, "--meta", meta_, "--to", "nowhere"},
           {"emulate", capture_, "--meta", meta_, "--to", "127.0.0.1:9", "--rate", "-1"},
           {"no-such-command"}}) {
    EXPECT_EQ(run_glint(arguments).exit_code, kUsage) << ::testing::PrintToString(arguments);
  }
}

TEST_F(BadInputTest, FolderThatCannotBeMadeIsNamed) {
  write_capture(packets());
  save_text(out_, "a file where the folder should be");
  const CommandResult result = dump();
  EXPECT_EQ(result.exit_code, kBadInput) << result.out;
  EXPECT_THAT(result.out, HasSubstr("--out"));
}

TEST_F(BadInputTest, FrameRangeIsDumped) {
  write_capture(packets());
  EXPECT_EQ(
      run_glint({"dump", capture_, "--meta", meta_, "--out", out_, "--frames", "1:2"}).exit_code,
      kDone);
  EXPECT_TRUE(fs::exists(out_ / "frame_00001_range.npy"));
  EXPECT_FALSE(fs::exists(out_ / "frame_00000_range.npy"));
  EXPECT_FALSE(fs::exists(out_ / "frame_00002_range.npy"));
  EXPECT_FALSE(fs::exists(out_ / "frame_00001_range2.npy"));
}

TEST_F(BadInputTest, InfoWithoutMetadataListsTheFlows) {
  write_capture(packets());
  const CommandResult result = run_glint({"info", capture_});
  ASSERT_EQ(result.exit_code, kDone) << result.out;
  const auto info = nlohmann::json::parse(result.out);
  EXPECT_EQ(info.at("link_type"), "EN10MB");
  EXPECT_EQ(info.at("flows").at(0).at("port"), 7502);
  EXPECT_FALSE(info.contains("frames"));
}

TEST_F(BadInputTest, InfoCountsLossesAndReorders) {
  auto all = packets();
  std::swap(all[3], all[4]);
  all.erase(all.begin() + 40);
  write_capture(all);
  const CommandResult result = run_glint({"info", capture_, "--meta", meta_});
  ASSERT_EQ(result.exit_code, kDone) << result.out;
  const auto info = nlohmann::json::parse(result.out);
  EXPECT_EQ(info.at("frames"), 3);
  EXPECT_EQ(info.at("losses"), 1);
  EXPECT_EQ(info.at("reorders"), 1);
  EXPECT_EQ(info.at("restarts"), 0);
  EXPECT_EQ(info.at("profile"), "RNG19_RFL8_SIG16_NIR16");
  EXPECT_NEAR(info.at("completeness").get<double>(), 1.0 - 1.0 / 96.0, 1e-9);
}

}  // namespace
}  // namespace glint
