// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A stream of datagrams into the assembler, for every profile. The input says what comes: packets
// as a sensor sends them, such packets with bytes overwritten, and any bytes.
#include <random>

#include "driver/core/packet_view.hpp"
#include "driver/core/packet_writer.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/test_sensor.hpp"
#include "tests/fuzz/byte_feed.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using glint::LidarScan;
using glint::SensorInfo;
using glint::fuzz::ByteFeed;
using glint::fuzz::require;

constexpr std::size_t kMaxDatagrams = 400;

SensorInfo choose_sensor(ByteFeed& feed) {
  const auto profiles = glint::lidar_profiles();
  const auto profile = profiles[feed.byte() % profiles.size()];
  const unsigned size = feed.byte();
  const int columns = 16 << (size & 3U);
  SensorInfo info =
      glint::test::make_sensor(profile, 1 + static_cast<int>(size >> 2U & 7U), columns);
  info.columns_per_packet = 1 << (size >> 5U);
  if (info.columns_per_packet > 16) info.columns_per_packet = 16;
  const unsigned flags = feed.byte();
  if ((flags & 1U) != 0) info.header = glint::PacketHeader::kFusa;
  if ((flags & 2U) != 0) info.serial_number.clear();
  if ((flags & 4U) != 0) info.init_id = 0;
  if ((flags & 8U) != 0) {
    info.column_window = {feed.byte() % columns, feed.byte() % columns};
  }
  return info;
}

/// The sensor's packets, two of each place of a scan: what is mutated must not be guessed.
class Sender {
 public:
  explicit Sender(const SensorInfo& info)
      : info_(info), writer_(info), random_(1), scan_(glint::test::random_scan(info, 0, random_)) {}

  /// Packet `index` of a scan, its columns' times as long after the start as the scan's number.
  void write(std::uint16_t frame, int index, std::vector<std::byte>& out) {
    scan_.frame_id = frame;
    for (int m = 0; m < info_.columns_per_frame; ++m) {
      scan_.column_time[static_cast<std::size_t>(m)] = glint::test::nominal_time(info_, frame, m);
    }
    writer_.write(scan_, index % writer_.packets_per_scan(), out);
  }

 private:
  const SensorInfo info_;
  const glint::PacketWriter writer_;
  std::mt19937 random_;
  LidarScan scan_;
};

void next_datagram(ByteFeed& feed, Sender& sender, std::size_t packet_bytes,
                   std::vector<std::byte>& out) {
  const unsigned kind = feed.byte();
  if ((kind & 3U) == 0) {
    const auto bytes = feed.bytes(feed.word() % (2 * packet_bytes));
    out.assign(bytes.begin(), bytes.end());
    return;
  }
  const std::uint16_t frame = (kind & 4U) != 0 ? feed.word() : feed.byte();
  sender.write(frame, feed.byte(), out);
  if ((kind & 3U) == 1) return;
  for (unsigned i = 0; i < 1 + (kind >> 4U); ++i) {
    const std::size_t at = feed.word() % out.size();
    out[at] = static_cast<std::byte>(feed.byte());
  }
}

void look_at(const glint::PacketFormat& format, std::span<const std::byte> datagram) {
  const auto view = glint::PacketView::parse(format, datagram);
  if (!view) return;
  static_cast<void>(view->crc_matches());
  require(view->health().thermal_state < 16 && view->health().shot_limiting_state < 16,
          "states have four bits");
  for (int i = 0; i < view->column_count(); ++i) {
    const auto column = view->column(i);
    require(column.time().ns >= 0 && column.time().ns <= std::int64_t{1} << 62U,
            "times are in range");
    for (std::size_t c = 0; c < glint::kChannelCount; ++c) {
      const auto channel = static_cast<glint::Channel>(c);
      const auto& field = format.layout->field(channel);
      const auto largest = ((std::uint64_t{1} << static_cast<unsigned>(field.width_bits)) - 1) *
                           static_cast<unsigned>(field.scale);
      require(column.value(channel, format.pixels_per_column - 1) <= largest,
              "values fit their field");
    }
  }
}

template <class T>
bool column_is_zero(const glint::Image<T>& image, int column) {
  for (int r = 0; r < image.rows; ++r) {
    if (image(r, column) != 0) return false;
  }
  return true;
}

void check_scan(const LidarScan& scan, const glint::PacketFormat& format) {
  const auto columns = static_cast<std::size_t>(format.columns_per_frame);
  require(scan.column_time.size() == columns && scan.column_status.size() == columns,
          "there is a time and a status for each column");
  require(scan.range_mm.rows == format.pixels_per_column &&
              scan.range_mm.cols == format.columns_per_frame,
          "images have the sensor's size");
  require(scan.columns_received <= scan.columns_expected &&
              scan.columns_expected <= format.columns_per_frame,
          "no more columns than expected");
  for (int m = 0; m < format.columns_per_frame; ++m) {
    if ((scan.column_status[static_cast<std::size_t>(m)] & 1U) != 0) continue;
    require(column_is_zero(scan.range_mm, m) && column_is_zero(scan.signal, m) &&
                column_is_zero(scan.reflectivity, m) && column_is_zero(scan.near_ir, m) &&
                column_is_zero(scan.range2_mm, m),
            "columns that did not come or are invalid are zero");
  }
}

/// Takes what is ready, and counts it.
class Receiver {
 public:
  explicit Receiver(const glint::ScanAssembler& assembler) : assembler_(assembler) {}

  void take(glint::ScanAssembler& assembler) {
    while (const LidarScan* scan = assembler.next()) {
      ++taken_;
      check_scan(*scan, assembler_.format());
      require(taken_ == 1 || scan->sequence > sequence_, "scans leave in their order");
      sequence_ = scan->sequence;
    }
  }
  void check_counters() const {
    const auto& counters = assembler_.counters();
    require(counters.scans == taken_ + counters.untaken_scans, "every scan is taken or counted");
    require(counters.incomplete_scans <= counters.scans, "incomplete scans are scans");
  }

 private:
  const glint::ScanAssembler& assembler_;
  std::uint64_t taken_ = 0;
  std::uint64_t sequence_ = 0;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteFeed feed(glint::fuzz::as_bytes(data, size));
  const SensorInfo info = choose_sensor(feed);
  glint::ScanAssembler assembler(info, {.reorder_window_packets = feed.byte() % 8});
  Sender sender(info);
  Receiver receiver(assembler);
  std::vector<std::byte> datagram;
  for (std::size_t i = 0; i < kMaxDatagrams && !feed.empty(); ++i) {
    next_datagram(feed, sender, assembler.format().packet_bytes, datagram);
    look_at(assembler.format(), datagram);
    assembler.push(datagram);
    // A slow taker now and then.
    if (i % 7 != 0) receiver.take(assembler);
  }
  assembler.flush();
  receiver.take(assembler);
  receiver.check_counters();
  return 0;
}
