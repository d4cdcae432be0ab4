// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/capture_writer.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "driver/core/error.hpp"
#include "pcap/capture_reader.hpp"
#include "pcap/internet_checksum.hpp"
#include "pcap/test_capture.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Buffer;
using ::testing::HasSubstr;

constexpr HostTime kTime{1'700'000'000'123'456'789};

std::span<const std::byte> as_payload(const Buffer& bytes) {
  return std::as_bytes(std::span(bytes));
}

class CaptureWriterTest : public ::testing::Test {
 protected:
  /// Writes one datagram and reads it back.
  Buffer round_trip(const Buffer& payload, bool is_v6, int mtu) {
    CaptureWriter writer(file_, {mtu});
    writer.write(kTime, test::sender(is_v6), test::receiver(is_v6), as_payload(payload));
    writer.finish();
    CaptureReader reader(file_);
    const Datagram* const datagram = reader.next();
    if (datagram == nullptr) return {};
    EXPECT_EQ(datagram->host_time, kTime);
    EXPECT_EQ(datagram->source, test::sender(is_v6));
    EXPECT_EQ(datagram->destination, test::receiver(is_v6));
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(datagram->payload.data());
    Buffer read(bytes, bytes + datagram->payload.size());
    EXPECT_EQ(reader.next(), nullptr);
    records_ = reader.counters().records;
    return read;
  }

  const test::TempDir dir_;
  const fs::path file_ = dir_ / "written.pcap";
  std::uint64_t records_ = 0;
};

TEST_F(CaptureWriterTest, WholeDatagramsReadBackEqual) {
  for (const bool is_v6 : {false, true}) {
    for (const std::size_t size : {0UL, 1UL, 48UL, 12608UL, 33024UL, 65487UL}) {
      const Buffer payload = test::pattern(size, 1);
      EXPECT_EQ(round_trip(payload, is_v6, 0), payload) << size;
      EXPECT_EQ(records_, 1U);
    }
  }
}

TEST_F(CaptureWriterTest, FragmentedDatagramsReadBackEqual) {
  for (const bool is_v6 : {false, true}) {
    const Buffer payload = test::pattern(12609, 1);
    EXPECT_EQ(round_trip(payload, is_v6, 1500), payload);
    EXPECT_EQ(records_, 9U);
  }
}

TEST_F(CaptureWriterTest, DatagramThatFitsTheMtuIsNotFragmented) {
  const Buffer payload = test::pattern(1472, 1);
  EXPECT_EQ(round_trip(payload, false, 1500), payload);
  EXPECT_EQ(records_, 1U);
}

TEST_F(CaptureWriterTest, ChecksumsAreRight) {
  const Buffer payload = test::pattern(101, 5);
  round_trip(payload, false, 0);
  std::ifstream in(file_, std::ios::binary);
  const Buffer bytes{std::istreambuf_iterator<char>(in), {}};
  const Bytes packet = Bytes(bytes).subspan(24 + 16 + 14);  // File, record and Ethernet headers.
  EXPECT_EQ(internet_checksum(packet.first(20)), 0);
  EXPECT_NE(load_be16(packet, 20 + 6), 0);
  EXPECT_EQ(udp_checksum(test::sender().address, test::receiver().address, packet.subspan(20)), 0);
}

TEST_F(CaptureWriterTest, FileHasItsNameOnlyWhenFinished) {
  {
    CaptureWriter writer(file_);
    writer.write(kTime, test::sender(), test::receiver(), {});
    EXPECT_FALSE(fs::exists(file_));
  }
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_FALSE(fs::exists(file_.string() + ".part"));
}

TEST_F(CaptureWriterTest, InPlaceWhatWasFlushedIsReadableWhateverBecomesOfTheWriter) {
  const Buffer payload = test::pattern(12608, 1);
  CaptureWriter writer(file_, {.in_place = true});
  for (int i = 0; i < 3; ++i) {
    writer.write(kTime, test::sender(), test::receiver(), as_payload(payload));
  }
  writer.flush();
  EXPECT_EQ(fs::file_size(file_), writer.bytes());
  // Another is cut short, as by the end of the process.
  writer.write(kTime, test::sender(), test::receiver(), as_payload(payload));
  writer.sync();
  fs::resize_file(file_, fs::file_size(file_) - 100);
  CaptureReader reader(file_);
  int datagrams = 0;
  while (reader.next() != nullptr) ++datagrams;
  EXPECT_EQ(datagrams, 3);
}

TEST_F(CaptureWriterTest, EarlierFileStaysUntilFinished) {
  test::save(file_, {1, 2, 3});
  CaptureWriter writer(file_);
  EXPECT_EQ(fs::file_size(file_), 3U);
  writer.finish();
  EXPECT_EQ(fs::file_size(file_), 24U);
}

TEST_F(CaptureWriterTest, FolderThatIsNotThereIsNamed) {
  try {
    CaptureWriter writer(dir_ / "no" / "where.pcap");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("where.pcap"), HasSubstr("No such file")));
  }
}

TEST_F(CaptureWriterTest, FullDiskIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  // The writer opens FILE.part: let that be the device on which every write fails.
  fs::create_symlink("/dev/full", file_.string() + ".part");
  CaptureWriter writer(file_);
  const Buffer payload(60000, 1);
  const auto write_all = [&] {
    for (int i = 0; i < 10; ++i) {
      writer.write(kTime, test::sender(), test::receiver(), as_payload(payload));
    }
    writer.finish();
  };
  EXPECT_THROW(write_all(), InputError);
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(CaptureWriterTest, ImpossibleDatagramsAreRefused) {
  CaptureWriter writer(file_);
  const Buffer payload(65508, 1);
  EXPECT_THROW(writer.write(kTime, test::sender(), test::receiver(), as_payload(payload)),
               InputError);
  EXPECT_THROW(writer.write(kTime, test::sender(), test::receiver(true), {}), InputError);
  EXPECT_THROW(CaptureWriter(dir_ / "x.pcap", {100}), InputError);
}

}  // namespace
}  // namespace glint
