// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

namespace glint::daemon {

/// Where the HOST:PORT of the configuration key `key` is. @throws ConfigError when it is none,
/// std::runtime_error when its name does not resolve.
boost::asio::ip::tcp::endpoint resolve_listen(boost::asio::io_context& io,
                                              const std::string& address, const char* key);

/// Listens there. @throws std::runtime_error naming `key` when the port is taken.
void listen_at(boost::asio::ip::tcp::acceptor& acceptor,
               const boost::asio::ip::tcp::endpoint& endpoint, const char* key);

}  // namespace glint::daemon
