// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/udp_source.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "driver/core/error.hpp"

namespace glint {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65'535;
constexpr int kWait_ms = 100;

constexpr int kMaxDiscardedInARow = 256;

// IPv4 addresses are kept in their IPv6-mapped form, so that one comparison serves both families.
in6_addr map_ipv4(const in_addr& v4) {
  in6_addr mapped{};
  mapped.s6_addr[10] = mapped.s6_addr[11] = 0xFF;
  std::memcpy(&mapped.s6_addr[12], &v4, sizeof v4);
  return mapped;
}

bool is_mapped_ipv4(const in6_addr& address) {
  const std::array<std::uint8_t, 12> prefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
  return std::memcmp(&address, prefix.data(), prefix.size()) == 0;
}

in6_addr parse_address(const std::string& text, const char* what) {
  in6_addr v6{};
  in_addr v4{};
  if (inet_pton(AF_INET6, text.c_str(), &v6) == 1) return v6;
  if (inet_pton(AF_INET, text.c_str(), &v4) == 1) return map_ipv4(v4);
  throw InputError(fmt::format("the {} {} is no IP address; write it like 192.0.2.5 or 2001:db8::5",
                               what, text));
}

// The sockets API takes every kind of address through this one pointer type.
sockaddr* generic(sockaddr_storage& address) { return reinterpret_cast<sockaddr*>(&address); }

in6_addr address_of(const sockaddr_storage& from) {
  if (from.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &from, sizeof v6);
    return v6.sin6_addr;
  }
  sockaddr_in v4{};
  std::memcpy(&v4, &from, sizeof v4);
  return map_ipv4(v4.sin_addr);
}

// What to bind to: its family follows from the address; no address means both families.
socklen_t fill_bind_address(const std::string& text, int family, std::uint16_t port,
                            sockaddr_storage& out) {
  const in6_addr address = text.empty() ? in6_addr{} : parse_address(text, "bind address");
  if (family == AF_INET6) {
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(port);
    v6.sin6_addr = address;
    std::memcpy(&out, &v6, sizeof v6);
    return sizeof v6;
  }
  sockaddr_in v4{};
  v4.sin_family = AF_INET;
  v4.sin_port = htons(port);
  std::memcpy(&v4.sin_addr, &address.s6_addr[12], sizeof v4.sin_addr);
  std::memcpy(&out, &v4, sizeof v4);
  return sizeof v4;
}

[[noreturn]] void fail_to_bind(const std::string& address, std::uint16_t port, int why) {
  switch (why) {
    case EADDRINUSE:
      throw InputError(
          fmt::format("port {} is held by another program; \"ss -ulnp sport = :{}\" names it: stop "
                      "it, or let the sensor send to another port",
                      port, port));
    case EACCES:
      throw InputError(
          fmt::format("port {} needs privileges; let the sensor send to a port above 1023", port));
    case EADDRNOTAVAIL:
      throw InputError(fmt::format(
          "the bind address {} is none of this machine's; \"ip address\" lists them", address));
    default:
      throw InputError(fmt::format("port {} cannot be opened: {}", port, std::strerror(why)));
  }
}

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

template <class T>
bool set_option(const Descriptor& socket, int level, int option, T value) {
  return setsockopt(socket.get(), level, option, &value, sizeof value) == 0;
}

struct BoundSocket {
  Descriptor fd;
  std::uint16_t port;
  std::uint32_t drops_told = 0;  // the kernel's count for this socket, which wraps
};

Descriptor open_socket(const std::string& bind_address, int& family) {
  const bool want_ipv4 =
      !bind_address.empty() && is_mapped_ipv4(parse_address(bind_address, "bind address"));
  family = want_ipv4 ? AF_INET : AF_INET6;
  Descriptor fd(socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (fd.get() >= 0 || !bind_address.empty()) return fd;
  family = AF_INET;  // a machine without IPv6
  return Descriptor(socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

BoundSocket bind_socket(const UdpSourceOptions& options, std::uint16_t port) {
  int family = AF_INET6;
  BoundSocket bound{open_socket(options.bind_address, family), port};
  if (bound.fd.get() < 0) fail_to_bind(options.bind_address, port, errno);
  if (family == AF_INET6) {
    set_option(bound.fd, IPPROTO_IPV6, IPV6_V6ONLY, options.bind_address.empty() ? 0 : 1);
  }
  sockaddr_storage address{};
  socklen_t size = fill_bind_address(options.bind_address, family, port, address);
  if (bind(bound.fd.get(), generic(address), size) != 0) {
    fail_to_bind(options.bind_address, port, errno);
  }
  size = sizeof address;
  getsockname(bound.fd.get(), generic(address), &size);
  // The port lies at the same place in the addresses of both families.
  sockaddr_in named{};
  std::memcpy(&named, &address, sizeof named);
  bound.port = ntohs(named.sin_port);
  // The first needs a capability and passes over the system's limit.
  if (!set_option(bound.fd, SOL_SOCKET, SO_RCVBUFFORCE, options.rcvbuf_bytes)) {
    set_option(bound.fd, SOL_SOCKET, SO_RCVBUF, options.rcvbuf_bytes);
  }
  set_option(bound.fd, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(bound.fd, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  return bound;
}

}  // namespace

struct UdpSource::Impl {
  explicit Impl(const UdpSourceOptions& options);

  SourceStatus read(RawPacket& packet);
  SourceStatus wait();
  SourceStatus receive(BoundSocket& socket, RawPacket& packet);
  void take_control_data(msghdr& message, BoundSocket& socket, RawPacket& packet);

  std::optional<in6_addr> source;
  Descriptor wake{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  std::vector<std::byte> buffer = std::vector<std::byte>(kMaxDatagramBytes);
  std::vector<BoundSocket> sockets;
  std::vector<pollfd> polled;  // one a socket, then the wake descriptor
  std::size_t last = 0;        // socket read last: the others come first, so that none starves
  std::string error;

  std::atomic<bool> stopped = false;
  std::atomic<std::uint64_t> foreign = 0;
  std::atomic<std::uint64_t> truncated = 0;
  std::atomic<std::uint64_t> kernel_drops = 0;
};

UdpSource::Impl::Impl(const UdpSourceOptions& options) {
  if (!options.source_address.empty()) {
    source = parse_address(options.source_address, "source address");
  }
  sockets.push_back(bind_socket(options, options.lidar_port));
  if (options.imu_port != 0 && options.imu_port != options.lidar_port) {
    sockets.push_back(bind_socket(options, options.imu_port));
  }
  for (const BoundSocket& socket : sockets) polled.push_back({socket.fd.get(), POLLIN, 0});
  polled.push_back({wake.get(), POLLIN, 0});
}

SourceStatus UdpSource::Impl::read(RawPacket& packet) {
  for (int discarded = 0; discarded < kMaxDiscardedInARow; ++discarded) {
    const SourceStatus waited = wait();
    if (waited != SourceStatus::kPacket) return waited;
    const SourceStatus received = receive(sockets[last], packet);
    if (received != SourceStatus::kIdle) return received;
  }
  return SourceStatus::kIdle;
}

// Waits until a socket has something to read and makes it `last`; kIdle when none has in time.
SourceStatus UdpSource::Impl::wait() {
  if (stopped) return SourceStatus::kEnd;
  const int count = poll(polled.data(), polled.size(), kWait_ms);
  if (stopped) return SourceStatus::kEnd;
  if (count < 0 && errno != EINTR) {
    error = fmt::format("waiting for packets failed: {}", std::strerror(errno));
    return SourceStatus::kError;
  }
  if (count <= 0) return SourceStatus::kIdle;
  for (std::size_t step = 1; step <= sockets.size(); ++step) {
    const std::size_t i = (last + step) % sockets.size();
    if (polled[i].revents == 0) continue;
    last = i;
    return SourceStatus::kPacket;
  }
  return SourceStatus::kIdle;
}

// Reads one datagram; kIdle when there was none, or one to discard.
SourceStatus UdpSource::Impl::receive(BoundSocket& socket, RawPacket& packet) {
  sockaddr_storage from{};
  alignas(cmsghdr) std::array<std::byte, 256> control;
  iovec payload{buffer.data(), buffer.size()};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &payload;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(socket.fd.get(), &message, 0);
  if (size < 0) {
    if (errno == EAGAIN || errno == EINTR) return SourceStatus::kIdle;
    error = fmt::format("reading port {} failed: {}", socket.port, std::strerror(errno));
    return SourceStatus::kError;
  }
  take_control_data(message, socket, packet);
  if (source) {
    const in6_addr sender = address_of(from);
    if (std::memcmp(&sender, &*source, sizeof sender) != 0) {
      ++foreign;
      return SourceStatus::kIdle;
    }
  }
  if ((message.msg_flags & MSG_TRUNC) != 0) {
    ++truncated;
    return SourceStatus::kIdle;
  }
  packet.port = socket.port;
  packet.bytes.assign(buffer.begin(), buffer.begin() + size);
  return SourceStatus::kPacket;
}

void UdpSource::Impl::take_control_data(msghdr& message, BoundSocket& socket, RawPacket& packet) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(c), sizeof time);
      packet.host_time = {time.tv_sec * kNsPerSecond + time.tv_nsec};
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t drops = 0;
      std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
      kernel_drops += drops - socket.drops_told;
      socket.drops_told = drops;
    }
  }
}

UdpSource::UdpSource(const UdpSourceOptions& options) : impl_(std::make_unique<Impl>(options)) {}
UdpSource::~UdpSource() = default;

SourceStatus UdpSource::read(RawPacket& packet) { return impl_->read(packet); }

void UdpSource::stop() {
  impl_->stopped = true;
  eventfd_write(impl_->wake.get(), 1);
}

std::uint64_t UdpSource::kernel_drops() const { return impl_->kernel_drops; }

const char* UdpSource::error() const { return impl_->error.c_str(); }

UdpCounters UdpSource::counters() const {
  return {impl_->foreign, impl_->truncated, impl_->kernel_drops};
}

std::uint16_t UdpSource::lidar_port() const { return impl_->sockets.front().port; }

int UdpSource::granted_rcvbuf_bytes() const {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  getsockopt(impl_->sockets.front().fd.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;  // the kernel doubles what is asked for, for its own book-keeping
}

}  // namespace glint
