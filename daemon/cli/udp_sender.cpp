// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/udp_sender.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "driver/core/error.hpp"

namespace glint::cli {
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

UdpSender::UdpSender(const std::string& host, std::uint16_t port)
    : target_(fmt::format("{} port {}", host, port)) {
  const AddressList addresses = resolve(host, port);
  for (const addrinfo* a = addresses.get(); a != nullptr; a = a->ai_next) {
    socket_ = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (socket_ < 0) continue;
    const int allow = 1;
    setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &allow, sizeof(allow));
    if (connect(socket_, a->ai_addr, a->ai_addrlen) == 0) return;
    close(socket_);
    socket_ = -1;
  }
  throw InputError(fmt::format("No route to {}: {}; check the address and the network.", target_,
                               std::strerror(errno)));
}

UdpSender::~UdpSender() { close(socket_); }

void UdpSender::send(std::span<const std::byte> datagram) const {
  // A refusal tells that nobody listened to an earlier datagram; this one has not been sent then.
  while (::send(socket_, datagram.data(), datagram.size(), 0) < 0) {
    if (errno == ECONNREFUSED || errno == EINTR) continue;
    throw std::runtime_error(fmt::format("A datagram of {} bytes cannot be sent to {}: {}.",
                                         datagram.size(), target_, std::strerror(errno)));
  }
}

}  // namespace glint::cli
