// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/udp_source.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "driver/core/error.hpp"
#include "driver/receive_batch.hpp"
#include "driver/socket_address.hpp"

namespace glint {
namespace {

constexpr int kWait_ms = 100;

std::optional<SocketAddress> parse_source(const std::string& address) {
  if (address.empty()) return std::nullopt;
  return SocketAddress::parse(address, "source address");
}

struct Port {
  Port(const UdpSocketOptions& options, std::uint16_t port) : socket(options, port) {}

  UdpSocket socket;
  ReceiveBatch batch;
  HostTime complete_to;  ///< All that arrived before is in the batch or was handed out.
};

HostTime now() {
  return {
      duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

}  // namespace

struct UdpSource::Impl {
  explicit Impl(const UdpSourceOptions& options);

  SourceStatus read(RawPacket& packet);
  SourceStatus wait();
  SourceStatus receive(HostTime before);
  Port* earliest();

  Descriptor wake{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  std::deque<Port> ports;
  std::vector<pollfd> polled;  // one a port, then the wake descriptor
  std::string error;

  std::atomic<bool> stopped = false;
  ReceiveCounters counters;

  std::mutex mutex;
  std::optional<SocketAddress> source;  // guarded by mutex
};

UdpSource::Impl::Impl(const UdpSourceOptions& options)
    : source(parse_source(options.source_address)) {
  ports.emplace_back(options, options.lidar_port);
  if (options.imu_port != 0 && options.imu_port != options.lidar_port) {
    ports.emplace_back(options, options.imu_port);
  }
  for (const Port& port : ports) polled.push_back({port.socket.get(), POLLIN, 0});
  polled.push_back({wake.get(), POLLIN, 0});
}

SourceStatus UdpSource::Impl::read(RawPacket& packet) {
  if (stopped) return SourceStatus::kEnd;
  Port* port = earliest();
  if (port == nullptr) {
    const SourceStatus waited = wait();
    if (waited != SourceStatus::kPacket) return waited;
    for (Port& waiting : ports) waiting.complete_to = {};  // The host's clock may have gone back.
    const SourceStatus received = receive(now());
    if (received != SourceStatus::kPacket) return received;
    port = earliest();
    if (port == nullptr) return SourceStatus::kIdle;
  }
  // What the other port had not got yet when it was read last may have come first.
  const SourceStatus received = receive(port->batch.time());
  if (received != SourceStatus::kPacket) return received;
  port = earliest();
  packet.host_time = port->batch.time();
  packet.port = port->socket.port();
  port->batch.take(packet.bytes);
  return SourceStatus::kPacket;
}

// The port whose batch has the datagram that came first; null when nothing is left.
Port* UdpSource::Impl::earliest() {
  Port* first = nullptr;
  for (Port& port : ports) {
    if (port.batch.empty()) continue;
    if (first == nullptr || port.batch.time() < first->batch.time()) first = &port;
  }
  return first;
}

// Waits until a socket has something to read (kPacket); kIdle when none has in time.
SourceStatus UdpSource::Impl::wait() {
  const int count = poll(polled.data(), polled.size(), kWait_ms);
  if (stopped) return SourceStatus::kEnd;
  if (count < 0 && errno != EINTR) {
    error = fmt::format("waiting for packets failed: {}", std::strerror(errno));
    return SourceStatus::kError;
  }
  return count > 0 ? SourceStatus::kPacket : SourceStatus::kIdle;
}

// Reads a batch from each socket that may hold what arrived before that time and was not read.
SourceStatus UdpSource::Impl::receive(HostTime before) {
  for (Port& port : ports) {
    if (!port.batch.empty() || port.complete_to >= before) continue;
    std::optional<SocketAddress> only;
    {
      const std::lock_guard lock(mutex);
      only = source;
    }
    const HostTime read_at = now();
    const int failure = port.batch.receive(port.socket.get(), only, counters);
    if (failure != 0 && failure != EAGAIN && failure != EINTR) {
      error = fmt::format("reading port {} failed: {}", port.socket.port(), std::strerror(failure));
      return SourceStatus::kError;
    }
    port.complete_to = port.batch.full() ? HostTime{} : read_at;
  }
  return SourceStatus::kPacket;
}

UdpSource::UdpSource(const UdpSourceOptions& options) : impl_(std::make_unique<Impl>(options)) {}
UdpSource::~UdpSource() = default;

SourceStatus UdpSource::read(RawPacket& packet) { return impl_->read(packet); }

void UdpSource::stop() {
  impl_->stopped = true;
  eventfd_write(impl_->wake.get(), 1);
}

std::uint64_t UdpSource::kernel_drops() const { return impl_->counters.kernel_drops; }

std::uint64_t UdpSource::foreign() const { return impl_->counters.foreign; }

std::uint64_t UdpSource::truncated() const { return impl_->counters.truncated; }

const char* UdpSource::error() const { return impl_->error.c_str(); }

void UdpSource::set_source_address(const std::string& address) {
  const std::optional<SocketAddress> source = parse_source(address);
  const std::lock_guard lock(impl_->mutex);
  impl_->source = source;
}

std::uint16_t UdpSource::lidar_port() const { return impl_->ports.front().socket.port(); }

int UdpSource::granted_rcvbuf_bytes() const {
  return impl_->ports.front().socket.granted_rcvbuf_bytes();
}

}  // namespace glint
