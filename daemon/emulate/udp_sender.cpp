// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/emulate/udp_sender.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "driver/core/error.hpp"

namespace glint::daemon {
namespace {

struct AddressListDeleter {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
using AddressList = std::unique_ptr<addrinfo, AddressListDeleter>;

AddressList resolve(const std::string& host, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* list = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
  if (error == 0) return AddressList(list);
  throw InputError(
      fmt::format("The host {} has no address: {}; check its name, or give its address.", host,
                  gai_strerror(error)));
}

}  // namespace

UdpSender::UdpSender(const std::string& host, std::uint16_t port, const std::string& from)
    : target_(fmt::format("{} port {}", host, port)) {
  const AddressList addresses = resolve(host, port);
  for (const addrinfo* a = addresses.get(); a != nullptr; a = a->ai_next) {
    if (open(*a, from)) return;
  }
  throw InputError(fmt::format("No route to {}{}: {}; check the address and the network.", target_,
                               from.empty() ? "" : " from " + from, std::strerror(errno)));
}

UdpSender::~UdpSender() { close(socket_); }

bool UdpSender::open(const addrinfo& target, const std::string& from) {
  socket_ = socket(target.ai_family, target.ai_socktype | SOCK_CLOEXEC, target.ai_protocol);
  if (socket_ < 0) return false;
  const int allow = 1;
  setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &allow, sizeof(allow));
  const AddressList own = from.empty() ? AddressList() : resolve(from, 0);
  const bool bound = !own || bind(socket_, own->ai_addr, own->ai_addrlen) == 0;
  if (bound && connect(socket_, target.ai_addr, target.ai_addrlen) == 0) return true;
  const int error = errno;
  close(std::exchange(socket_, -1));
  errno = error;
  return false;
}

void UdpSender::send(std::span<const std::byte> datagram) const {
  if (try_send(datagram)) return;
  throw std::runtime_error(fmt::format("A datagram of {} bytes cannot be sent to {}: {}.",
                                       datagram.size(), target_, std::strerror(errno)));
}

bool UdpSender::try_send(std::span<const std::byte> datagram) const {
  // A refusal tells that nobody listened to an earlier datagram; this one has not been sent then.
  while (::send(socket_, datagram.data(), datagram.size(), 0) < 0) {
    if (errno != ECONNREFUSED && errno != EINTR) return false;
  }
  return true;
}

}  // namespace glint::daemon
