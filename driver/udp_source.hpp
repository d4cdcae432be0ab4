// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "driver/core/packet_source.hpp"
#include "driver/udp_socket.hpp"

namespace glint {

struct UdpSourceOptions : UdpSocketOptions {
  std::uint16_t lidar_port = 7502;  ///< 0: any free port, see UdpSource::lidar_port().
  std::uint16_t imu_port = 7503;    ///< 0: no IMU port is opened. May equal lidar_port.
  /// See UdpSource::set_source_address().
  std::string source_address;
};

/// Live datagrams of one sensor in the order of their arrival, with the kernel's times of it. How
/// ports are held, see UdpSocket. read() from one thread, everything else from any.
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
  [[nodiscard]] std::uint64_t foreign() const override;
  /// From the thread of read() only.
  [[nodiscard]] const char* error() const override;

  /// From now on, datagrams from other addresses are counted as foreign and dropped; empty: all
  /// are taken. @throws InputError when it is no address.
  void set_source_address(const std::string& address) override;

  /// Datagrams larger than UDP allows, which the kernel cut and which were dropped.
  [[nodiscard]] std::uint64_t truncated() const;
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
