// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/looped_capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string>

#include "driver/core/error.hpp"
#include "driver/core/packet_view.hpp"

namespace glint::emulator {
namespace {

constexpr int kCrcSamples = 16;
// More than this is no loss of packets: the sensor restarted, or its clock jumped.
constexpr std::int64_t kMostScansAhead = 100;
constexpr std::int64_t kLongestStep_ns = 2 * kNsPerSecond;

std::uint64_t serial_number_of(const SensorInfo& info) {
  std::uint64_t serial = 0;
  const std::string& text = info.serial_number;
  std::from_chars(text.data(), text.data() + text.size(), serial);
  return serial;
}

/// Signed difference of two frame ids in the width of the field.
std::int64_t frame_difference(std::uint32_t a, std::uint32_t b, int bits) {
  const std::uint32_t difference = a - b;
  return bits == 16 ? std::int64_t{static_cast<std::int16_t>(difference)}
                    : std::int64_t{static_cast<std::int32_t>(difference)};
}

}  // namespace

/// What is learned of the scans while the packets are read. Scans are numbered from that of the
/// first packet, which may itself be preceded by stragglers.
struct LoopedCapture::Survey {
  struct Scan {
    std::vector<bool> seen;  ///< By packet of the scan.
    std::uint32_t packets = 0;
    std::uint32_t frame_id = 0;
    SensorTime first_time;  ///< Of its first packet's first column.
  };

  explicit Survey(const SensorInfo& info)
      : format(info), serial_number(serial_number_of(info)), init_id(info.init_id) {}

  /// The packet's scan; null when the sensor restarted: what follows is another stream.
  std::optional<std::int64_t> add(std::span<const std::byte> bytes);

  PacketFormat format;
  std::uint64_t serial_number;
  std::uint32_t init_id;
  std::map<std::int64_t, Scan> scans;
  bool started = false;
  std::uint32_t stream_init_id = 0;
  std::uint32_t newest_frame_id = 0;
  std::int64_t newest = 0;
  SensorTime last_time;
  int crc_samples = 0;
  int crc_matches = 0;
};

std::optional<std::int64_t> LoopedCapture::Survey::add(std::span<const std::byte> bytes) {
  if (!started && !format.legacy()) {
    format.header = recognise_header(bytes, serial_number, init_id).value_or(format.header);
  }
  const auto packet = PacketView::parse(format, bytes);
  if (!packet) return newest;  // By its size it is one; it is sent as part of the newest scan.
  if (!started) {
    newest_frame_id = packet->frame_id();
    stream_init_id = packet->init_id();
  }
  const std::int64_t ahead =
      frame_difference(packet->frame_id(), newest_frame_id, format.frame_id_bits());
  const ColumnView column = packet->column(0);
  const bool another_stream = started && (std::abs(ahead) > kMostScansAhead ||
                                          std::abs(column.time() - last_time) > kLongestStep_ns ||
                                          packet->init_id() != stream_init_id);
  if (another_stream) return std::nullopt;
  started = true;
  last_time = column.time();
  const std::int64_t number = newest + ahead;
  if (ahead > 0) {
    newest = number;
    newest_frame_id = packet->frame_id();
  }
  if (crc_samples < kCrcSamples) {
    ++crc_samples;
    if (packet->crc_matches()) ++crc_matches;
  }
  const int index = column.measurement_id() / format.columns_per_packet;
  Scan& scan = scans[number];
  scan.seen.resize(static_cast<std::size_t>(format.columns_per_frame / format.columns_per_packet) +
                   1);
  const auto place = static_cast<std::size_t>(index);
  if (place >= scan.seen.size() || scan.seen[place]) return number;
  scan.seen[place] = true;
  if (scan.packets++ == 0) {
    scan.frame_id = packet->frame_id();
    scan.first_time = column.time();
  }
  scan.first_time = std::min(scan.first_time, column.time());
  return number;
}

LoopedCapture::LoopedCapture(PacketSource& source, const SensorInfo& info, std::size_t max_bytes)
    : restamper_(PacketFormat(info), ImuPacketFormat(info), false) {
  Survey survey(info);
  read(source, info, max_bytes, survey);
  const bool crc_right = survey.crc_samples > 0 && survey.crc_matches == survey.crc_samples;
  restamper_ = PacketRestamper(survey.format, ImuPacketFormat(info), crc_right);
  keep_whole_scans(survey, info.scan_period_ns());
}

void LoopedCapture::read(PacketSource& source, const SensorInfo& info, std::size_t max_bytes,
                         Survey& survey) {
  const std::size_t imu_bytes = ImuPacketFormat(info).packet_bytes;
  RawPacket packet;
  for (SourceStatus status = source.read(packet); status != SourceStatus::kEnd;
       status = source.read(packet)) {
    if (status == SourceStatus::kError) throw InputError(source.error());
    if (status == SourceStatus::kIdle) continue;
    Packet entry{packet.host_time.ns, packet.bytes.size() == imu_bytes, 0, bytes_.size(),
                 packet.bytes.size()};
    if (!entry.is_imu) {
      const auto scan = survey.add(packet.bytes);
      if (!scan) return;
      entry.scan = static_cast<std::uint32_t>(*scan);  // Wraps for stragglers before the first.
    }
    if (bytes_.size() + packet.bytes.size() > max_bytes) {
      throw InputError(
          fmt::format("A capture that is looped is kept in memory, and this one passes {} MB; cut "
                      "it to a shorter one, a few seconds are enough.",
                      max_bytes >> 20U));
    }
    bytes_.insert(bytes_.end(), packet.bytes.begin(), packet.bytes.end());
    packets_.push_back(entry);
  }
}

void LoopedCapture::keep_whole_scans(const Survey& survey, std::int64_t scan_period_ns) {
  for (const auto& [number, scan] : survey.scans) {
    packets_per_scan_ = std::max(packets_per_scan_, scan.packets);
  }
  const auto is_whole = [&](const auto& row) {
    return row.first >= 0 && row.second.packets == packets_per_scan_;
  };
  const auto first = std::ranges::find_if(survey.scans, is_whole);
  if (first == survey.scans.end()) {
    throw InputError("The capture holds no lidar packet of this sensor, so it cannot be looped.");
  }
  const auto last = std::ranges::find_if(survey.scans.rbegin(), survey.scans.rend(), is_whole);
  const std::int64_t count = last->first - first->first + 1;
  scans_ = static_cast<std::uint32_t>(count);
  first_frame_id_ = first->second.frame_id;
  first_time_ = first->second.first_time;

  // The mean scan, unless the times are no times.
  period_ns_ = count * scan_period_ns;
  if (count > 1) {
    const std::int64_t measured_ns = (last->second.first_time - first_time_) / (count - 1) * count;
    const bool plausible = measured_ns > period_ns_ / 4 && measured_ns < period_ns_ * 4;
    if (plausible) period_ns_ = measured_ns;
  }

  const auto first_scan = static_cast<std::uint32_t>(first->first);
  const auto begins = std::ranges::find_if(
      packets_, [&](const Packet& p) { return !p.is_imu && p.scan == first_scan; });
  const std::int64_t begin_ns = begins->offset_ns;
  std::erase_if(packets_, [&](const Packet& p) {
    const std::int64_t offset_ns = p.offset_ns - begin_ns;
    return p.is_imu ? offset_ns < 0 || offset_ns >= period_ns_ : p.scan - first_scan >= scans_;
  });
  for (Packet& p : packets_) {
    p.offset_ns -= begin_ns;
    if (p.is_imu) continue;
    p.scan -= first_scan;
    ++lidar_packets_;
  }
}

}  // namespace glint::emulator
