// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/column_decoder.hpp"

#include <gtest/gtest.h>

#include "driver/core/packet_view.hpp"
#include "driver/core/profile_table.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

constexpr int kColumns = 128;

// Random bytes in all columns of a packet, the status and flags among them.
test::Bytes random_packet(const PacketFormat& format, std::mt19937& random) {
  // Not a byte more than the packet, so that a sanitizer sees a read past its end.
  test::Bytes packet(format.packet_bytes);
  for (std::byte& byte : packet) byte = static_cast<std::byte>(random());
  return packet;
}

// A scan with every pixel set, so that those written by mistake show.
LidarScan painted_scan(const PacketFormat& format) {
  LidarScan scan(format);
  const auto paint = []<class T>(Image<T>& image) { image.data.assign(image.data.size(), 4711); };
  paint(scan.range_mm);
  paint(scan.signal);
  paint(scan.reflectivity);
  paint(scan.near_ir);
  paint(scan.range2_mm);
  paint(scan.signal2);
  paint(scan.reflectivity2);
  return scan;
}

// What the decoders must do, a pixel at a time.
LidarScan expected_scan(const PacketFormat& format, const std::byte* packet, int first_column) {
  LidarScan scan = painted_scan(format);
  const auto fill = [&]<class T>(Channel channel, Image<T>& image) {
    for (int c = 0; c < format.columns_per_packet && !image.empty(); ++c) {
      const ColumnView column(format, packet + format.layout->packet_header_bytes +
                                          static_cast<std::size_t>(c) * format.column_bytes);
      for (int row = 0; row < image.rows; ++row) {
        image(row, first_column + c) = static_cast<T>(column.value(channel, row));
      }
    }
  };
  fill(Channel::kRange, scan.range_mm);
  fill(Channel::kSignal, scan.signal);
  fill(Channel::kReflectivity, scan.reflectivity);
  fill(Channel::kNearIr, scan.near_ir);
  fill(Channel::kRange2, scan.range2_mm);
  fill(Channel::kSignal2, scan.signal2);
  fill(Channel::kReflectivity2, scan.reflectivity2);
  return scan;
}

class ColumnDecoder : public testing::TestWithParam<std::size_t> {};

TEST_P(ColumnDecoder, BothPathsWriteWhatThePixelsHoldAndNothingElse) {
  const LidarProfile profile = kProfileTable[GetParam()].profile;
  std::mt19937 random(3);
  for (const int rows : {1, 3, 5, 8, 17, 31, 64}) {
    for (const int columns_per_packet : {1, 2, 4, 8, 16, 32, 64}) {
      SensorInfo info = test::make_sensor(profile, rows, kColumns);
      info.columns_per_packet = columns_per_packet;
      const std::size_t packet_bytes = 64 + static_cast<std::size_t>(columns_per_packet) *
                                                (32 + static_cast<std::size_t>(rows) * 20);
      if (packet_bytes > 65'000) continue;  // no datagram can carry it
      const PacketFormat format(info);
      const test::Bytes packet = random_packet(format, random);
      // Also at a column that no vector is aligned to.
      for (const int first :
           {0, columns_per_packet == 64 ? 63 : 37, kColumns - columns_per_packet}) {
        const LidarScan expected = expected_scan(format, packet.data(), first);
        for (const DecoderPath path : {DecoderPath::kFastest, DecoderPath::kPortable}) {
          LidarScan scan = painted_scan(format);
          const std::byte* pixels = packet.data() + format.layout->packet_header_bytes +
                                    format.layout->column_header_bytes;
          column_decoder(profile, path)(format, pixels, columns_per_packet, first, scan);
          EXPECT_TRUE(test::same_columns(scan, expected))
              << to_string(profile) << ", " << rows << " rows, " << columns_per_packet
              << " columns at " << first << ", path " << static_cast<int>(path);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, ColumnDecoder,
                         testing::Range(std::size_t{0}, kProfileTable.size()),
                         [](const auto& profile) {
                           return std::string(to_string(kProfileTable[profile.param].profile));
                         });

}  // namespace
}  // namespace glint
