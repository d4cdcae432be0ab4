// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A stream of datagrams into the assembler, for every profile. The input says what comes: packets
// as a sensor sends them, such packets with bytes overwritten, and any bytes.
#include <algorithm>
#include <optional>
#include <random>

#include "driver/core/imu_packet_writer.hpp"
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

constexpr std::size_t kMaxSteps = 400;

SensorInfo choose_sensor(ByteFeed& feed) {
  const auto profiles = glint::lidar_profiles();
  const auto profile = profiles[feed.byte() % profiles.size()];
  const unsigned size = feed.byte();
  const int columns = 16 << (size & 3U);
  SensorInfo info =
      glint::test::make_sensor(profile, 1 + static_cast<int>(size >> 2U & 7U), columns);
  info.columns_per_packet = std::min(1 << (size >> 5U), 16);
  const unsigned flags = feed.byte();
  if ((flags & 1U) != 0) info.header = glint::PacketHeader::kFusa;
  if ((flags & 2U) != 0) info.serial_number.clear();
  if ((flags & 4U) != 0) info.init_id = 0;
  if ((flags & 16U) != 0) info.imu_profile = glint::ImuProfile::kAccel32Gyro32Nmea;
  if ((flags & 8U) != 0) {
    info.column_window = {feed.byte() % columns, feed.byte() % columns};
  }
  return info;
}

/// The sensor's packets, for what is only damaged must not be guessed whole.
class Sender {
 public:
  explicit Sender(const SensorInfo& info)
      : info_(info),
        writer_(info),
        imu_writer_(info),
        random_(1),
        scan_(glint::test::random_scan(info, 0, random_)) {}

  /// A packet of a scan, its columns' times as long after the start as the scan's number.
  void write_lidar(std::uint32_t frame, int index, std::vector<std::byte>& out) {
    scan_.frame_id = frame;
    for (int m = 0; m < info_.columns_per_frame; ++m) {
      scan_.column_time[static_cast<std::size_t>(m)] = glint::test::nominal_time(info_, frame, m);
    }
    writer_.write(scan_, index % writer_.packets_per_scan(), out);
  }
  void write_imu(std::vector<std::byte>& out) const {
    const auto count = static_cast<std::size_t>(imu_writer_.format().measurements);
    imu_writer_.write(std::vector<glint::ImuSample>(count), 1, 0, out);
  }

 private:
  const SensorInfo info_;
  const glint::PacketWriter writer_;
  const glint::ImuPacketWriter imu_writer_;
  std::mt19937 random_;
  LidarScan scan_;
};

/// What the input does next.
enum class Step { kDatagram, kFlush, kOtherIdentity, kOtherSensor };

Step next_step(ByteFeed& feed, Sender& sender, std::size_t packet_bytes,
               std::vector<std::byte>& out) {
  const unsigned kind = feed.byte();
  if ((kind & 3U) == 0) {
    const auto bytes = feed.bytes(feed.word() % (2 * packet_bytes));
    out.assign(bytes.begin(), bytes.end());
    return Step::kDatagram;
  }
  if ((kind & 3U) == 3) {
    sender.write_imu(out);
    return static_cast<Step>(kind >> 2U & 3U);
  }
  const std::uint32_t frame = (kind & 4U) != 0 ? feed.word() * 0x1'0001U : feed.byte();
  sender.write_lidar(frame, feed.byte(), out);
  if ((kind & 3U) == 1) return Step::kDatagram;
  for (unsigned i = 0; i < 1 + (kind >> 4U); ++i) {
    const std::size_t at = feed.word() % out.size();
    out[at] = static_cast<std::byte>(feed.byte());
  }
  return Step::kDatagram;
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

/// An assembler, what is done to it, and what it must keep to.
class Stream {
 public:
  Stream(SensorInfo info, glint::AssemblerOptions options)
      : info_(std::move(info)), assembler_(info_, options) {}

  [[nodiscard]] const glint::PacketFormat& format() const { return assembler_.format(); }

  void push(std::span<const std::byte> datagram) {
    look_at(format(), datagram);
    assembler_.push(datagram);
    ++pushed_;
  }
  void flush() { assembler_.flush(); }
  void change_identity() {
    info_.init_id ^= 1U;
    assembler_.set_identity(info_);
  }
  /// Drops what was not taken.
  Sender change_sensor() {
    take();
    info_ = glint::test::make_sensor(info_.profile, info_.pixels_per_column % 8 + 1, 32);
    assembler_.change_sensor(info_);
    return Sender(info_);
  }
  void take() {
    while (const LidarScan* scan = assembler_.next()) {
      ++taken_;
      check_scan(*scan, format());
      require(taken_ == 1 || scan->sequence > sequence_, "scans leave in their order");
      sequence_ = scan->sequence;
    }
  }
  void check_counters() const {
    const auto& counters = assembler_.counters();
    require(counters.datagrams() == pushed_, "every datagram is in one counter");
    require(counters.scans >= taken_ + counters.untaken_scans, "every scan is counted");
    require(counters.incomplete_scans <= counters.scans, "incomplete scans are scans");
  }

 private:
  SensorInfo info_;
  glint::ScanAssembler assembler_;
  std::uint64_t pushed_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t sequence_ = 0;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteFeed feed(glint::fuzz::as_bytes(data, size));
  const SensorInfo info = choose_sensor(feed);
  Stream stream(info, {.reorder_window_packets = feed.byte() % 8});
  std::optional<Sender> sender(info);
  std::vector<std::byte> datagram;
  for (std::size_t i = 0; i < kMaxSteps && !feed.empty(); ++i) {
    switch (next_step(feed, *sender, stream.format().packet_bytes, datagram)) {
      case Step::kDatagram:
        stream.push(datagram);
        break;
      case Step::kFlush:
        stream.flush();
        break;
      case Step::kOtherIdentity:
        stream.change_identity();
        break;
      case Step::kOtherSensor:
        sender.emplace(stream.change_sensor());
        break;
    }
    // A slow taker now and then.
    if (i % 7 != 0) stream.take();
  }
  stream.flush();
  stream.take();
  stream.check_counters();
  return 0;
}
