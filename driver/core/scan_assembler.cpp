// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/scan_assembler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "driver/core/arrival_ledger.hpp"
#include "driver/core/column_decoder.hpp"
#include "driver/core/open_scan.hpp"
#include "driver/core/scan_numbering.hpp"

namespace glint {
namespace {

// Scans that may be open at a time; the oldest leaves when a further one begins.
constexpr std::size_t kMaxOpenScans = 4;
// Scans that may wait for next(): a restart makes all open ones leave, and the packet that told of
// it may complete another.
constexpr std::size_t kMaxReadyScans = kMaxOpenScans + 1;
// A further buffer is in the caller's hands.
constexpr std::size_t kBuffers = kMaxOpenScans + kMaxReadyScans + 1;

// Time of the first valid column; of the first one when none is.
SensorTime packet_time(const PacketView& packet) {
  for (int i = 0; i < packet.column_count(); ++i) {
    if (packet.column(i).valid()) return packet.column(i).time();
  }
  return packet.column(0).time();
}

// Its first column, counted on through all scans.
std::int64_t position_of(const PacketView& packet, std::int64_t sequence, int columns_per_frame) {
  const int id = packet.column(0).measurement_id();
  return sequence * columns_per_frame + std::min(id, columns_per_frame - 1);
}

}  // namespace

struct ScanAssembler::Impl {
  Impl(const SensorInfo& info, AssemblerOptions given);

  PacketVerdict push(std::span<const std::byte> datagram);
  void flush();
  const LidarScan* next();

  void restart();
  bool any_column_expected(const PacketView& packet);
  OpenScan* find_or_open(const PacketView& packet);
  OpenScan* open_scan(const PacketView& packet);
  void place(const PacketView& packet, OpenScan& scan);
  bool fits_whole(const PacketView& packet, const OpenScan& scan) const;
  bool place_column(const ColumnView& column, OpenScan& scan) const;
  void mark_arrived(const ColumnView& column, OpenScan& scan) const;
  bool finished(const OpenScan& scan) const;
  void leave_oldest();
  void take_back();

  PacketGate gate;
  const PacketFormat& format = gate.format();
  const ColumnWindow window;
  const DecodeColumns decode;
  const AssemblerOptions options;
  const std::int64_t scan_period_ns;
  const std::int64_t timeout_columns;
  AssemblerCounters counters;
  ScanNumbering numbering;
  ArrivalLedger ledger;
  ClockWatch clock;

  std::vector<OpenScan> buffers;  // never resized: the lists below point into it
  std::vector<OpenScan*> free;    // last in, first out, so that a warm buffer is used again
  std::vector<OpenScan*> open;    // by sequence, oldest first
  std::vector<OpenScan*> ready;   // in the order they left
  OpenScan* lent = nullptr;       // what next() gave last

  std::int64_t newest_position = 0;  // of the packets placed, counted on through all scans
  bool tell_restart = false;         // the next scan to leave is the first after a restart
};

ScanAssembler::Impl::Impl(const SensorInfo& info, AssemblerOptions given)
    : gate(info),
      window(info),
      decode(column_decoder(info.profile)),
      options(given),
      scan_period_ns(info.scan_period_ns()),
      timeout_columns(std::llround(given.timeout_periods * info.columns_per_frame)),
      numbering(format, window.packets, scan_period_ns),
      ledger(window, info.columns_per_packet),
      clock(scan_period_ns) {
  buffers.reserve(kBuffers);
  free.reserve(kBuffers);
  open.reserve(kMaxOpenScans);
  ready.reserve(kMaxReadyScans);
  for (std::size_t i = 0; i < kBuffers; ++i) free.push_back(&buffers.emplace_back(format));
}

PacketVerdict ScanAssembler::Impl::push(std::span<const std::byte> datagram) {
  take_back();
  const PacketGate::Decision decision = gate.decide(datagram, counters);
  if (decision.restarted) restart();
  if (decision.verdict == PacketVerdict::kOutdated) {
    ++counters.late_packets;
    if (numbering.late() == ScanNumbering::Fit::kBegunAnew) {
      // It was no restart but a damaged init id.
      restart();
      gate.forget_init_id();
    }
  }
  if (!decision.packet) return decision.verdict;
  const PacketView& packet = *decision.packet;
  if (!any_column_expected(packet)) {
    ++counters.packets;
  } else if (OpenScan* scan = find_or_open(packet)) {
    numbering.fitted();
    place(packet, *scan);
    while (!open.empty() && finished(*open.front())) leave_oldest();
  }
  return decision.verdict;
}

// Frame ids begin anew: what is open leaves as it is.
void ScanAssembler::Impl::restart() {
  while (!open.empty()) leave_oldest();
  numbering.begin_anew();
  ledger.begin_anew();
  clock.begin_anew();
  tell_restart = true;
  ++counters.restarts;
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

// The open scan that a packet belongs to, opened if need be; null when it is discarded.
OpenScan* ScanAssembler::Impl::find_or_open(const PacketView& packet) {
  const std::int64_t sequence = numbering.sequence(packet.frame_id());
  const auto at = std::ranges::lower_bound(open, sequence, {}, &OpenScan::sequence);
  if (at != open.end() && (*at)->sequence == sequence) return *at;
  const bool no_room = open.size() == kMaxOpenScans && at == open.begin();
  switch (numbering.fit(packet.frame_id(), packet_time(packet), no_room)) {
    case ScanNumbering::Fit::kLate:
      ++counters.late_packets;
      return nullptr;
    case ScanNumbering::Fit::kStray:
      ++counters.stray_packets;
      return nullptr;
    case ScanNumbering::Fit::kBegunAnew:
      restart();
      break;
    case ScanNumbering::Fit::kFits:
      break;
  }
  return open_scan(packet);
}

OpenScan* ScanAssembler::Impl::open_scan(const PacketView& packet) {
  if (open.size() == kMaxOpenScans) leave_oldest();
  const std::uint32_t frame_id = packet.frame_id();
  const std::int64_t sequence = numbering.sequence(frame_id);
  numbering.scan_opened(frame_id, packet_time(packet));
  OpenScan* scan = free.back();
  free.pop_back();
  scan->start(frame_id, sequence, position_of(packet, sequence, format.columns_per_frame));
  open.insert(std::ranges::lower_bound(open, sequence, {}, &OpenScan::sequence), scan);
  return scan;
}

void ScanAssembler::Impl::place(const PacketView& packet, OpenScan& scan) {
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
  newest_position =
      std::max(newest_position, position_of(packet, scan.sequence, format.columns_per_frame));
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

// Whether the oldest scan may leave: it is complete, or packets of newer ones say that the rest is
// lost.
bool ScanAssembler::Impl::finished(const OpenScan& scan) const {
  if (scan.expected_arrived == window.count) return true;
  if (scan.newer_packets >= std::max(1, options.reorder_window_packets)) return true;
  // Two, for one may have a damaged frame id.
  return scan.newer_packets >= 2 && newest_position - scan.opened_at > timeout_columns;
}

void ScanAssembler::Impl::leave_oldest() {
  OpenScan* scan = open.front();
  open.erase(open.begin());
  scan->finish(window, scan_period_ns, clock);
  scan->scan.sensor_restarted = std::exchange(tell_restart, false);
  numbering.scan_left(scan->sequence);
  ++counters.scans;
  if (scan->expected_arrived < window.count) ++counters.incomplete_scans;
  if (scan->scan.clock_jumped) ++counters.clock_jumps;
  counters.missing_packets += ledger.missing(*scan, open.empty());
  if (ready.size() == kMaxReadyScans) {
    free.push_back(ready.front());
    ready.erase(ready.begin());
    ++counters.untaken_scans;
  }
  ready.push_back(scan);
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

PacketVerdict ScanAssembler::push(std::span<const std::byte> datagram) {
  return impl_->push(datagram);
}
const LidarScan* ScanAssembler::next() { return impl_->next(); }
void ScanAssembler::flush() { impl_->flush(); }

void ScanAssembler::set_identity(const SensorInfo& info) { impl_->gate.set_identity(info); }

void ScanAssembler::change_sensor(const SensorInfo& info) {
  auto fresh = std::make_unique<Impl>(info, impl_->options);
  fresh->counters = impl_->counters;
  fresh->numbering.begin_after(impl_->numbering);
  fresh->tell_restart = true;
  impl_ = std::move(fresh);
}

const AssemblerCounters& ScanAssembler::counters() const { return impl_->counters; }
const PacketFormat& ScanAssembler::format() const { return impl_->format; }
const std::optional<PacketHealth>& ScanAssembler::health() const { return impl_->gate.health(); }

}  // namespace glint
