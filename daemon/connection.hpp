// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <functional>
#include <memory>

namespace boost::asio::ssl {
class context;
}

namespace glint::daemon {

/// The bytes from and to one client: a socket, or TLS on one. Each handler is called once, later,
/// on the main thread, and must keep the connection alive.
class Connection {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  using Error = boost::system::error_code;
  using OnOpen = std::function<void(Error)>;
  using OnBytes = std::function<void(Error, std::size_t)>;

  Connection() = default;
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// To be waited for before anything is read or written.
  virtual void open(OnOpen on_open) = 0;
  virtual void read_some(boost::asio::mutable_buffer buffer, OnBytes on_bytes) = 0;
  virtual void write_some(boost::asio::const_buffer buffer, OnBytes on_bytes) = 0;
  virtual Socket& socket() = 0;
};

std::unique_ptr<Connection> make_plain_connection(Connection::Socket socket);
/// `context` must outlive the connection.
std::unique_ptr<Connection> make_tls_connection(Connection::Socket socket,
                                                boost::asio::ssl::context& context);

}  // namespace glint::daemon
