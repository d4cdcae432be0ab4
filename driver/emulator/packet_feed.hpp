// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <memory>

#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/emulator/looped_capture.hpp"

namespace glint::emulator {

/// A packet on its way out.
struct FedPacket {
  RawPacket packet;  ///< Host time: when it is due, ns after begin() at recorded speed.
  bool is_imu = false;
  bool ends_scan = false;  ///< With it a whole scan has been fed; never of a verbatim capture.
};

/// What an emulated sensor sends, in order. Thread-compatible.
class PacketFeed {
 public:
  virtual ~PacketFeed() = default;
  /// The sensor starts to send, anew from the first packet.
  virtual void begin(std::uint32_t init_id, SensorTime first_time) = 0;
  /// The sensor's clock is off by so much from now on.
  virtual void set_clock_offset(std::int64_t offset_ns) = 0;
  /// The next packet, reusing the buffer; false at the end.
  virtual bool next(FedPacket& fed) = 0;
  /// Lidar packets of a whole scan; 0 when that is not known.
  [[nodiscard]] virtual std::uint64_t packets_per_scan() const = 0;
  /// At recorded speed; 0 when that is not known.
  [[nodiscard]] virtual double lidar_packets_per_s() const = 0;
};

/// A capture as it was recorded, once.
class VerbatimFeed final : public PacketFeed {
 public:
  VerbatimFeed(PacketSource& source, const SensorInfo& info);

  void begin(std::uint32_t, SensorTime) override {}
  void set_clock_offset(std::int64_t) override {}
  bool next(FedPacket& fed) override;
  [[nodiscard]] std::uint64_t packets_per_scan() const override { return 0; }
  [[nodiscard]] double lidar_packets_per_s() const override { return 0.0; }

 private:
  PacketSource& source_;
  const std::size_t imu_bytes_;
  std::int64_t first_ns_ = 0;
  bool started_ = false;
};

/// A capture's whole scans over and over: one stream whose frame ids begin at 0 and whose times run
/// on, as those of a sensor that has just started.
class LoopedFeed final : public PacketFeed {
 public:
  /// `capture` must outlive the feed. `loops` 0: for ever.
  LoopedFeed(const LoopedCapture& capture, std::uint64_t loops)
      : capture_(capture), loops_(loops) {}

  void begin(std::uint32_t init_id, SensorTime first_time) override;
  void set_clock_offset(std::int64_t offset_ns) override { clock_offset_ns_ = offset_ns; }
  bool next(FedPacket& fed) override;
  [[nodiscard]] std::uint64_t packets_per_scan() const override {
    return capture_.packets_per_scan();
  }
  [[nodiscard]] double lidar_packets_per_s() const override;

 private:
  const LoopedCapture& capture_;
  const std::uint64_t loops_;
  std::uint32_t init_id_ = 0;
  SensorTime first_time_;
  std::int64_t clock_offset_ns_ = 0;
  std::uint64_t loop_ = 0;
  std::size_t index_ = 0;
  std::uint64_t fed_of_scan_ = 0;
};

}  // namespace glint::emulator
