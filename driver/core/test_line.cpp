// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/test_line.hpp"

#include <algorithm>
#include <functional>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/open_scan.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/profile_table.hpp"

namespace glint::test {
namespace {

constexpr int kReorderWindow = 4;
constexpr int kLongestDelayOfADouble = 8;

// Random bits wherever a pixel has none of the fields, in the places of a packet's bytes: flags,
// zones, colours and what is reserved, which no decoder may take for its fields.
Bytes random_unused_bits(const SensorInfo& info, std::mt19937& random) {
  const PacketFormat format(info);
  const auto pixel_bytes = static_cast<std::size_t>(format.layout->pixel_bytes);
  Bytes unused(pixel_bytes, std::byte{0xFF});
  for (const PixelField& field : format.layout->fields) {
    for (int bit = field.offset_bits; bit < field.offset_bits + field.width_bits; ++bit) {
      unused[static_cast<std::size_t>(bit / 8)] &= ~(std::byte{1} << bit % 8);
    }
  }
  Bytes bits(format.packet_bytes);
  std::byte* column = bits.data() + format.layout->packet_header_bytes;
  for (int c = 0; c < format.columns_per_packet; ++c, column += format.column_bytes) {
    std::byte* pixel = column + format.layout->column_header_bytes;
    for (int r = 0; r < format.pixels_per_column; ++r, pixel += pixel_bytes) {
      for (std::size_t i = 0; i < pixel_bytes; ++i) {
        pixel[i] = static_cast<std::byte>(random()) & unused[i];
      }
    }
  }
  return bits;
}

}  // namespace

BadLine::BadLine(const SensorInfo& info, Faults faults, std::uint32_t seed)
    : info_(info),
      faults_(faults),
      random_(seed),
      column_expected_(ColumnWindow(info).expected),
      unused_bits_(random_unused_bits(info, random_)) {}

bool BadLine::chance(double share) {
  return std::uniform_real_distribution<double>(0, 1)(random_) < share;
}

void BadLine::restart() { ++info_.init_id; }

void BadLine::run(int count, std::uint32_t frame_id, bool cut) {
  std::vector<Bytes> run;
  run_arrived_.clear();
  for (int k = 0; k < count; ++k, ++frame_id) {
    if (k == count / 2) {
      scans_sent_ += outage_scans_;
      frame_id += static_cast<std::uint32_t>(outage_scans_);
      const auto packets = static_cast<std::size_t>(ColumnWindow(info_).packets);
      run_arrived_.insert(run_arrived_.end(), packets * static_cast<std::size_t>(outage_scans_),
                          false);
      outage_scans_ = 0;
    }
    if (PacketFormat(info_).frame_id_bits() == 16) frame_id &= 0xFFFFU;
    LidarScan scan = random_scan(info_, frame_id, random_);
    for (int m = 0; m < info_.columns_per_frame; ++m) {
      const auto column = static_cast<std::size_t>(m);
      scan.column_time[column] = nominal_time(info_, scans_sent_, m);
      if (column_expected_[column] == 0 || chance(0.01)) scan.column_status[column] = 0;
    }
    ++scans_sent_;
    const int packets = info_.columns_per_frame / info_.columns_per_packet;
    send(std::move(scan), cut && k + 1 == count ? packets / 2 : packets, run);
  }
  const auto first = std::ranges::find(run_arrived_, true);
  const auto last = std::find(run_arrived_.rbegin(), run_arrived_.rend(), true).base();
  never_arrived += static_cast<std::uint64_t>(std::count(first, std::max(first, last), false));
  arrived += static_cast<std::uint64_t>(std::ranges::count(run_arrived_, true));
  add_doubles(run);
  shuffle(run);
  wire.insert(wire.end(), run.begin(), run.end());
}

void BadLine::send(LidarScan scan, int packets, std::vector<Bytes>& run) {
  const int columns = info_.columns_per_packet;
  const std::vector<Bytes> all = encode(info_, scan);
  bool any = false;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    const auto begin = column_expected_.begin() + i * columns;
    if (std::count(begin, begin + columns, std::uint8_t{1}) == 0 || i >= packets) {
      clear_columns(scan, i * columns, (i + 1) * columns);
      continue;
    }
    run_arrived_.push_back(!chance(faults_.loss));
    if (!run_arrived_.back()) {
      clear_columns(scan, i * columns, (i + 1) * columns);
      continue;
    }
    any = true;
    run.push_back(all[static_cast<std::size_t>(i)]);
    fill_unused_bits(run.back());
  }
  for (int m = 0; m < info_.columns_per_frame; ++m) {
    if (scan.column_status[static_cast<std::size_t>(m)] == 0) clear_columns(scan, m, m + 1);
  }
  if (any) scans.push_back(std::move(scan));
}

// A double arrives some packets after the first, often when its scan has left.
void BadLine::add_doubles(std::vector<Bytes>& run) {
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (!chance(faults_.doubled)) continue;
    const std::size_t later = 1 + random_() % kLongestDelayOfADouble;
    const auto at = static_cast<std::ptrdiff_t>(std::min(i + later, run.size()));
    run.insert(run.begin() + at, Bytes(run[i]));
    ++doubled;
  }
}

// Not the very first, which say where the numbering begins, and never a whole scan before another:
// the later one leaves when it is complete.
void BadLine::shuffle(std::vector<Bytes>& run) {
  const std::ptrdiff_t block = std::min(kReorderWindow, ColumnWindow(info_).packets);
  for (std::ptrdiff_t begin = block; begin < std::ssize(run); begin += block) {
    const std::ptrdiff_t end = std::min(begin + block, std::ssize(run));
    std::shuffle(run.begin() + begin, run.begin() + end, random_);
  }
}

void BadLine::fill_unused_bits(Bytes& packet) {
  std::ranges::transform(packet, unused_bits_, packet.begin(), std::bit_or{});
  if (info_.profile == LidarProfile::kLegacy) return;
  const std::size_t covered = packet.size() - kPacketCrcBytes;
  store(packet.data() + covered, crc64(std::span(packet).first(covered)));
}

}  // namespace glint::test
