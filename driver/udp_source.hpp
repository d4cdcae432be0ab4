// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "driver/core/packet_source.hpp"

namespace glint {

struct UdpSourceOptions {
  /// Address of the interface to listen on, IPv4 or IPv6; empty: all of them, both families.
  std::string bind_address;
  std::uint16_t lidar_port = 7502;  ///< 0: any free port, see UdpSource::lidar_port().
  std::uint16_t imu_port = 7503;    ///< 0: no IMU port is opened. May equal lidar_port.
  /// Datagrams from any other address are counted and dropped; empty: all are taken.
  std::string source_address;
  int rcvbuf_bytes = 8 << 20;  ///< Asked for; see UdpSource::granted_rcvbuf_bytes().
};

struct UdpCounters {
  std::uint64_t foreign = 0;       ///< From another address than source_address.
  std::uint64_t truncated = 0;     ///< Larger than a UDP datagram's buffer; cut by the kernel.
  std::uint64_t kernel_drops = 0;  ///< Dropped by the kernel, its receive buffer being full.
};

/// Live datagrams of one sensor, with the kernel's times of arrival. The ports are held
/// exclusively, so no second program can take packets away. read() and counters() from one thread;
/// stop() and kernel_drops() from any.
class UdpSource final : public PacketSource {
 public:
  /// Opens and binds the sockets.
  /// @throws InputError when an address is none, or a port is held or may not be used.
  explicit UdpSource(const UdpSourceOptions& options);
  ~UdpSource() override;
  UdpSource(const UdpSource&) = delete;
  UdpSource& operator=(const UdpSource&) = delete;

  SourceStatus read(RawPacket& packet) override;
  void stop() override;
  [[nodiscard]] std::uint64_t kernel_drops() const override;
  [[nodiscard]] const char* error() const override;

  [[nodiscard]] UdpCounters counters() const;
  /// The ports bound, where options asked for any.
  [[nodiscard]] std::uint16_t lidar_port() const;
  /// Bytes of receive buffer that the kernel grants to each socket, in the unit of
  /// rcvbuf_bytes. Less than asked for means that net.core.rmem_max should be raised.
  [[nodiscard]] int granted_rcvbuf_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint
