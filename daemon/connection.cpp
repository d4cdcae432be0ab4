// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/connection.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <utility>

namespace glint::daemon {
namespace {

class PlainConnection : public Connection {
 public:
  explicit PlainConnection(Socket socket) : socket_(std::move(socket)) {}

  void open(OnOpen on_open) override {
    boost::asio::post(socket_.get_executor(), [on_open = std::move(on_open)] { on_open({}); });
  }
  void read_some(boost::asio::mutable_buffer buffer, OnBytes on_bytes) override {
    socket_.async_read_some(buffer, std::move(on_bytes));
  }
  void write_some(boost::asio::const_buffer buffer, OnBytes on_bytes) override {
    socket_.async_write_some(buffer, std::move(on_bytes));
  }
  Socket& socket() override { return socket_; }

 private:
  Socket socket_;
};

class TlsConnection : public Connection {
 public:
  TlsConnection(Socket socket, boost::asio::ssl::context& context)
      : stream_(std::move(socket), context) {}

  void open(OnOpen on_open) override {
    stream_.async_handshake(boost::asio::ssl::stream_base::server, std::move(on_open));
  }
  void read_some(boost::asio::mutable_buffer buffer, OnBytes on_bytes) override {
    stream_.async_read_some(buffer, std::move(on_bytes));
  }
  void write_some(boost::asio::const_buffer buffer, OnBytes on_bytes) override {
    stream_.async_write_some(buffer, std::move(on_bytes));
  }
  Socket& socket() override { return stream_.next_layer(); }

 private:
  boost::asio::ssl::stream<Socket> stream_;
};

}  // namespace

std::unique_ptr<Connection> make_plain_connection(Connection::Socket socket) {
  return std::make_unique<PlainConnection>(std::move(socket));
}

std::unique_ptr<Connection> make_tls_connection(Connection::Socket socket,
                                                boost::asio::ssl::context& context) {
  return std::make_unique<TlsConnection>(std::move(socket), context);
}

}  // namespace glint::daemon
