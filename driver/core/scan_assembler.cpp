// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/scan_assembler.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "driver/core/column_decoder.hpp"
#include "driver/core/open_scan.hpp"

namespace glint {
namespace {

// Scans that may be open at a time; the oldest leaves when a further one begins.
constexpr std::size_t kMaxOpenScans = 4;
// Scans that may wait for next(): a restart makes all open ones leave, and the packet that told of
// it may complete another.
constexpr std::size_t kMaxReadyScans = kMaxOpenScans + 1;
// A further buffer is in the caller's hands.
constexpr std::size_t kBuffers = kMaxOpenScans + kMaxReadyScans + 1;

// Difference of two frame ids that wrap at so many bits; half the range tells older from newer.
std::int64_t frame_difference(std::uint32_t a, std::uint32_t b, int bits) {
  const std::uint32_t difference = a - b;
  return bits == 16 ? std::int64_t{static_cast<std::int16_t>(difference)}
                    : std::int64_t{static_cast<std::int32_t>(difference)};
}

// Time of the first valid column; of the first one when none is.
SensorTime packet_time(const PacketView& packet) {
  for (int i = 0; i < packet.column_count(); ++i) {
    if (packet.column(i).valid()) return packet.column(i).time();
  }
  return packet.column(0).time();
}

std::uint64_t parse_serial_number(const std::string& text) {
  std::uint64_t serial = 0;
  std::from_chars(text.data(), text.data() + text.size(), serial);
  return serial;
}

}  // namespace

struct ScanAssembler::Impl {
  Impl(const SensorInfo& info, AssemblerOptions given);

  PacketError push(std::span<const std::byte> datagram);
  void flush();
  const LidarScan* next();

  void prove_header(std::span<const std::byte> datagram);
  PacketError refuse(PacketError why);
  bool check_init_id(std::uint32_t id);
  void restart();
  void discard(std::uint64_t& counter);
  bool any_column_expected(const PacketView& packet);
  OpenScan* find_or_open(std::uint32_t frame_id, SensorTime time);
  std::int64_t unwrap(std::uint32_t frame_id) const;
  bool leaps(std::int64_t sequence, SensorTime time) const;
  void place(const PacketView& packet, OpenScan& scan);
  bool fits_whole(const PacketView& packet, const OpenScan& scan) const;
  bool place_column(const ColumnView& column, OpenScan& scan) const;
  void mark_arrived(const ColumnView& column, OpenScan& scan) const;
  void let_finished_leave();
  void expire(SensorTime now);
  void leave_oldest();
  void count_missing(const OpenScan& scan);
  void take_back();

  PacketFormat format;  // constant but for the header, which packets may prove
  const ColumnWindow window;
  const DecodeColumns decode;
  const AssemblerOptions options;
  const std::int64_t scan_period_ns;
  const std::int64_t timeout_ns;
  std::uint64_t serial_number;  // 0: not known
  std::uint32_t metadata_init_id;
  bool header_proved = false;
  const std::uint64_t packets_per_scan;
  AssemblerCounters counters;

  std::vector<OpenScan> buffers;  // never resized: the lists below point into it
  std::vector<OpenScan*> free;    // last in, first out, so that a warm buffer is used again
  std::vector<OpenScan*> open;    // by sequence, oldest first
  std::vector<OpenScan*> ready;   // in the order they left
  OpenScan* lent = nullptr;       // what next() gave last

  bool started = false;       // a scan was opened since the start or the last restart
  bool tell_restart = false;  // the next scan to leave is the first after a restart
  std::uint32_t init_id = 0;
  std::uint32_t former_init_id = 0;
  std::uint32_t newest_frame_id = 0;   // of the newest scan ever opened, and its
  std::int64_t newest_sequence = -1;   // unwrapped id,
  SensorTime newest_time;              // and time
  std::int64_t left_sequence = -1;     // of the newest scan that left
  std::uint64_t misfits_in_a_row = 0;  // packets discarded by frame id since the last that fitted
};

ScanAssembler::Impl::Impl(const SensorInfo& info, AssemblerOptions given)
    : format(info),
      window(info),
      decode(column_decoder(info.profile)),
      options(given),
      scan_period_ns(info.scan_period_ns()),
      timeout_ns(std::llround(given.timeout_periods * static_cast<double>(scan_period_ns))),
      serial_number(parse_serial_number(info.serial_number)),
      metadata_init_id(info.init_id),
      packets_per_scan(static_cast<std::uint64_t>((window.count + info.columns_per_packet - 1) /
                                                  info.columns_per_packet)) {
  buffers.reserve(kBuffers);
  free.reserve(kBuffers);
  open.reserve(kMaxOpenScans);
  ready.reserve(kMaxReadyScans);
  for (std::size_t i = 0; i < kBuffers; ++i) free.push_back(&buffers.emplace_back(format));
}

PacketError ScanAssembler::Impl::push(std::span<const std::byte> datagram) {
  take_back();
  prove_header(datagram);
  PacketError error = PacketError::kNone;
  const auto packet = PacketView::parse(format, datagram, &error);
  if (!packet) return refuse(error);
  const std::uint64_t serial = packet->serial_number();
  if (serial != 0 && serial_number != 0 && serial != serial_number) {
    return refuse(PacketError::kSerial);
  }
  if (!check_init_id(packet->init_id())) return PacketError::kNone;
  const SensorTime time = packet_time(*packet);
  expire(time);
  if (!any_column_expected(*packet)) {
    ++counters.packets;
    return PacketError::kNone;
  }
  if (OpenScan* scan = find_or_open(packet->frame_id(), time)) {
    misfits_in_a_row = 0;
    place(*packet, *scan);
  }
  let_finished_leave();
  return PacketError::kNone;
}

// The manual gives two layouts for one profile, so the sensor's ids decide, where they are known.
void ScanAssembler::Impl::prove_header(std::span<const std::byte> datagram) {
  if (header_proved || format.legacy() || datagram.size() != format.packet_bytes) return;
  const auto header = recognise_header(datagram, serial_number, metadata_init_id);
  if (!header) return;
  format.header = *header;
  header_proved = true;
}

PacketError ScanAssembler::Impl::refuse(PacketError why) {
  switch (why) {
    case PacketError::kSize:
      ++counters.bad_size;
      break;
    case PacketError::kType:
      ++counters.bad_type;
      break;
    case PacketError::kSerial:
      ++counters.bad_serial;
      break;
    case PacketError::kNone:
      break;
  }
  return why;
}

// A new init id is a restarted sensor. False: the packet was sent before the restart and overtaken.
bool ScanAssembler::Impl::check_init_id(std::uint32_t id) {
  if (id == 0 || id == init_id) return true;
  if (id == former_init_id) {
    discard(counters.late_packets);
    return false;
  }
  if (init_id != 0) restart();
  former_init_id = init_id;
  init_id = id;
  return true;
}

// Frame ids begin anew: what is open leaves as it is.
void ScanAssembler::Impl::restart() {
  while (!open.empty()) leave_oldest();
  left_sequence = newest_sequence;
  started = false;
  tell_restart = true;
  misfits_in_a_row = 0;
  ++counters.restarts;
}

// A packet whose frame id does not fit. One scan's worth of them and nothing else: the ids began
// anew without an init id to tell of it (legacy packets have none).
void ScanAssembler::Impl::discard(std::uint64_t& counter) {
  ++counter;
  if (++misfits_in_a_row < packets_per_scan) return;
  restart();
  init_id = former_init_id = 0;
}

bool ScanAssembler::Impl::any_column_expected(const PacketView& packet) {
  bool any = false;
  for (int i = 0; i < packet.column_count(); ++i) {
    const std::uint16_t id = packet.column(i).measurement_id();
    if (id >= format.columns_per_frame) {
      ++counters.bad_column;
    } else {
      any = any || window.expected[id] != 0;
    }
  }
  return any;
}

// The open scan of this frame id, opened if need be; null when its packets are to be discarded.
OpenScan* ScanAssembler::Impl::find_or_open(std::uint32_t frame_id, SensorTime time) {
  const std::int64_t sequence = unwrap(frame_id);
  const auto at = std::ranges::lower_bound(open, sequence, {}, &OpenScan::sequence);
  if (at != open.end() && (*at)->sequence == sequence) return *at;
  const bool no_room = open.size() == kMaxOpenScans && at == open.begin();
  if (sequence <= left_sequence || no_room) {
    discard(counters.late_packets);
    return nullptr;
  }
  if (leaps(sequence, time)) {
    discard(counters.stray_packets);
    return nullptr;
  }
  auto position = at - open.begin();
  if (open.size() == kMaxOpenScans) {
    leave_oldest();
    --position;
  }
  OpenScan* scan = free.back();
  free.pop_back();
  scan->start(frame_id, sequence, time);
  open.insert(open.begin() + position, scan);
  if (sequence > newest_sequence) {
    newest_frame_id = frame_id;
    newest_sequence = sequence;
    newest_time = time;
  }
  started = true;
  return scan;
}

std::int64_t ScanAssembler::Impl::unwrap(std::uint32_t frame_id) const {
  if (started)
    return newest_sequence + frame_difference(frame_id, newest_frame_id, format.frame_id_bits());
  return newest_sequence < 0 ? frame_id : newest_sequence + 1;
}

// Whether a scan would lie further ahead than the time since the newest allows: a damaged frame id
// must not make everything after it late.
bool ScanAssembler::Impl::leaps(std::int64_t sequence, SensorTime time) const {
  const std::int64_t scans_ahead = sequence - newest_sequence;
  if (!started || scans_ahead <= static_cast<std::int64_t>(kMaxOpenScans)) return false;
  // The rate in the metadata may be off by a factor of two.
  return time - newest_time < scans_ahead * scan_period_ns / 4;
}

void ScanAssembler::Impl::place(const PacketView& packet, OpenScan& scan) {
  if (scan.first_time.ns == 0) scan.first_time = packet_time(packet);
  bool any_new = false;
  if (fits_whole(packet, scan)) {
    for (int i = 0; i < packet.column_count(); ++i) mark_arrived(packet.column(i), scan);
    const ColumnView first = packet.column(0);
    decode(format, first.pixels(), packet.column_count(), first.measurement_id(), scan.scan);
    any_new = true;
  } else {
    for (int i = 0; i < packet.column_count(); ++i) {
      any_new = place_column(packet.column(i), scan) || any_new;
    }
  }
  if (!any_new) {
    ++counters.duplicate_packets;
    return;
  }
  ++counters.packets;
  for (OpenScan* other : open) {
    if (other->sequence < scan.sequence) ++other->newer_packets;
  }
}

// Whether the packet is as nearly all are: neighbouring columns, all of them valid and new.
bool ScanAssembler::Impl::fits_whole(const PacketView& packet, const OpenScan& scan) const {
  const std::uint16_t first = packet.column(0).measurement_id();
  if (first + packet.column_count() > format.columns_per_frame) return false;
  for (int i = 0; i < packet.column_count(); ++i) {
    const ColumnView column = packet.column(i);
    if (column.measurement_id() != first + i || !column.valid()) return false;
    if (scan.arrived[column.measurement_id()] != 0) return false;
  }
  return true;
}

bool ScanAssembler::Impl::place_column(const ColumnView& column, OpenScan& scan) const {
  const std::uint16_t id = column.measurement_id();
  if (id >= format.columns_per_frame || scan.arrived[id] != 0) return false;
  mark_arrived(column, scan);
  if (column.valid()) decode(format, column.pixels(), 1, id, scan.scan);
  return true;
}

void ScanAssembler::Impl::mark_arrived(const ColumnView& column, OpenScan& scan) const {
  const std::uint16_t id = column.measurement_id();
  scan.arrived[id] = 1;
  scan.scan.column_time[id] = column.time();
  scan.scan.column_status[id] = column.status();
  if (window.expected[id] == 0) return;
  ++scan.expected_arrived;
  if (column.valid()) ++scan.scan.columns_received;
}

void ScanAssembler::Impl::let_finished_leave() {
  const auto finished = [&](const OpenScan& scan) {
    return scan.expected_arrived == window.count ||
           scan.newer_packets >= std::max(1, options.reorder_window_packets);
  };
  while (!open.empty() && finished(*open.front())) leave_oldest();
}

void ScanAssembler::Impl::expire(SensorTime now) {
  const auto expired = [&](const OpenScan& scan) {
    return scan.first_time.ns != 0 && now - scan.first_time > timeout_ns;
  };
  while (!open.empty() && expired(*open.front())) leave_oldest();
}

void ScanAssembler::Impl::leave_oldest() {
  OpenScan* scan = open.front();
  open.erase(open.begin());
  scan->finish(window, scan_period_ns);
  scan->scan.sensor_restarted = std::exchange(tell_restart, false);
  left_sequence = scan->sequence;
  ++counters.scans;
  if (scan->expected_arrived < window.count) ++counters.incomplete_scans;
  count_missing(*scan);
  if (ready.size() == kMaxReadyScans) {
    free.push_back(ready.front());
    ready.erase(ready.begin());
    ++counters.untaken_scans;
  }
  ready.push_back(scan);
}

void ScanAssembler::Impl::count_missing(const OpenScan& scan) {
  if (scan.expected_arrived == window.count) return;
  const int step = format.columns_per_packet;
  for (int begin = 0; begin < format.columns_per_frame; begin += step) {
    const auto any = [&](const std::vector<std::uint8_t>& flags) {
      return std::any_of(flags.begin() + begin, flags.begin() + begin + step,
                         [](std::uint8_t flag) { return flag != 0; });
    };
    if (any(window.expected) && !any(scan.arrived)) ++counters.missing_packets;
  }
}

// What next() gave last may be filled again.
void ScanAssembler::Impl::take_back() {
  if (lent != nullptr) free.push_back(std::exchange(lent, nullptr));
}

void ScanAssembler::Impl::flush() {
  take_back();
  while (!open.empty()) leave_oldest();
}

const LidarScan* ScanAssembler::Impl::next() {
  take_back();
  if (ready.empty()) return nullptr;
  lent = ready.front();
  ready.erase(ready.begin());
  return &lent->scan;
}

ScanAssembler::ScanAssembler(const SensorInfo& info, AssemblerOptions options)
    : impl_(std::make_unique<Impl>(info, options)) {}
ScanAssembler::~ScanAssembler() = default;

PacketError ScanAssembler::push(std::span<const std::byte> datagram) {
  return impl_->push(datagram);
}
const LidarScan* ScanAssembler::next() { return impl_->next(); }
void ScanAssembler::flush() { impl_->flush(); }

void ScanAssembler::set_identity(const SensorInfo& info) {
  impl_->serial_number = parse_serial_number(info.serial_number);
  impl_->metadata_init_id = info.init_id;
  impl_->header_proved = false;
}

void ScanAssembler::change_sensor(const SensorInfo& info) {
  auto fresh = std::make_unique<Impl>(info, impl_->options);
  fresh->counters = impl_->counters;
  fresh->newest_sequence = fresh->left_sequence = impl_->newest_sequence;
  fresh->tell_restart = true;
  impl_ = std::move(fresh);
}

const AssemblerCounters& ScanAssembler::counters() const { return impl_->counters; }
const PacketFormat& ScanAssembler::format() const { return impl_->format; }

}  // namespace glint
