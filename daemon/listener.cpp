// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/listener.hpp"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

#include "daemon/config.hpp"
#include "daemon/host_port.hpp"

namespace glint::daemon {

using boost::asio::ip::tcp;
using boost::system::error_code;

tcp::endpoint resolve_listen(boost::asio::io_context& io, const std::string& address,
                             const char* key) {
  const auto target = parse_host_port(address);
  if (!target) {
    throw ConfigError(fmt::format(
        "{} = \"{}\" is no HOST:PORT, e.g. \"127.0.0.1:7788\" or \"[::1]:7788\"", key, address));
  }
  error_code error;
  tcp::resolver resolver(io);
  const auto found =
      resolver.resolve(target->host, std::to_string(target->port), tcp::resolver::passive, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: cannot resolve {}: {}", key, target->host, error.message()));
  }
  return found.begin()->endpoint();
}

void listen_at(tcp::acceptor& acceptor, const tcp::endpoint& endpoint, const char* key) {
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  error_code error;
  acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  if (!error) return;
  std::ostringstream address;
  address << endpoint;
  throw std::runtime_error(
      fmt::format("cannot listen on {}: {}; stop the program that holds the port, or change {} "
                  "(--set {}=HOST:PORT)",
                  address.str(), error.message(), key, key));
}

}  // namespace glint::daemon
