// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/packet_feed.hpp"

#include "driver/core/error.hpp"

namespace glint::emulator {

VerbatimFeed::VerbatimFeed(PacketSource& source, const SensorInfo& info)
    : source_(source), imu_bytes_(ImuPacketFormat(info).packet_bytes) {}

bool VerbatimFeed::next(FedPacket& fed) {
  SourceStatus status = SourceStatus::kIdle;
  while (status == SourceStatus::kIdle) status = source_.read(fed.packet);
  if (status == SourceStatus::kError) throw InputError(source_.error());
  if (status == SourceStatus::kEnd) return false;
  if (!started_) first_ns_ = fed.packet.host_time.ns;
  started_ = true;
  fed.packet.host_time.ns -= first_ns_;
  fed.is_imu = fed.packet.bytes.size() == imu_bytes_;
  fed.ends_scan = false;
  return true;
}

void LoopedFeed::begin(std::uint32_t init_id, SensorTime first_time) {
  init_id_ = init_id;
  first_time_ = first_time;
  clock_offset_ns_ = 0;
  loop_ = 0;
  index_ = 0;
  fed_of_scan_ = 0;
}

bool LoopedFeed::next(FedPacket& fed) {
  if (index_ == capture_.packets().size()) {
    index_ = 0;
    ++loop_;
  }
  if (loops_ != 0 && loop_ >= loops_) return false;
  const LoopedCapture::Packet& from = capture_.packets()[index_++];
  const auto bytes = capture_.bytes(from);
  const std::int64_t loop_begin_ns = static_cast<std::int64_t>(loop_) * capture_.period_ns();
  fed.packet.bytes.assign(bytes.begin(), bytes.end());
  fed.packet.host_time = {loop_begin_ns + from.offset_ns};
  fed.is_imu = from.is_imu;
  const PacketStamp stamp{
      first_time_.ns - capture_.first_time().ns + loop_begin_ns + clock_offset_ns_,
      static_cast<std::uint32_t>(loop_ * capture_.scans()) - capture_.first_frame_id(), init_id_};
  if (from.is_imu) {
    capture_.restamper().restamp_imu(fed.packet.bytes, stamp);
    fed.ends_scan = false;
    return true;
  }
  capture_.restamper().restamp_lidar(fed.packet.bytes, stamp);
  fed.ends_scan = ++fed_of_scan_ == capture_.packets_per_scan();
  if (fed.ends_scan) fed_of_scan_ = 0;
  return true;
}

double LoopedFeed::lidar_packets_per_s() const {
  return static_cast<double>(capture_.lidar_packets()) /
         (static_cast<double>(capture_.period_ns()) * kSecondsPerNs);
}

}  // namespace glint::emulator
