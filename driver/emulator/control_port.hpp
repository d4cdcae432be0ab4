// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "driver/core/error.hpp"
#include "driver/emulator/emulator_core.hpp"

namespace glint::emulator {

/// A TCP port that opens and closes with the sensor's power, and takes its connections with it.
/// Thread-compatible: used on the thread that runs the io_context.
template <class Connection>
class ControlPort {
 public:
  ControlPort(boost::asio::io_context& io, boost::asio::ip::tcp::endpoint endpoint,
              EmulatorCore& core)
      : endpoint_(std::move(endpoint)), acceptor_(io), core_(core) {}

  void open() {
    boost::system::error_code error;
    acceptor_.open(endpoint_.protocol());
    acceptor_.set_option(boost::asio::ip::tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint_, error);
    if (!error) acceptor_.listen(boost::asio::ip::tcp::acceptor::max_listen_connections, error);
    if (error) {
      throw InputError(
          fmt::format("the emulated sensor cannot listen on port {}: {}; choose "
                      "another, or 0 for any",
                      endpoint_.port(), error.message()));
    }
    endpoint_ = acceptor_.local_endpoint();  // Later the same port again.
    accept();
  }

  void close() {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    for (const auto& weak : connections_) {
      if (const auto connection = weak.lock()) connection->close();
    }
    connections_.clear();
  }

  [[nodiscard]] std::uint16_t port() const { return endpoint_.port(); }

 private:
  void accept() {
    acceptor_.async_accept(
        [this, alive = std::weak_ptr<int>{alive_}](boost::system::error_code error,
                                                   boost::asio::ip::tcp::socket socket) {
          if (alive.expired() || error == boost::asio::error::operation_aborted ||
              !acceptor_.is_open()) {
            return;
          }
          if (!error) {
            std::erase_if(connections_, [](const auto& weak) { return weak.expired(); });
            const auto connection = std::make_shared<Connection>(std::move(socket), core_);
            connections_.push_back(connection);
            connection->start();
          }
          accept();
        });
  }

  boost::asio::ip::tcp::endpoint endpoint_;
  boost::asio::ip::tcp::acceptor acceptor_;
  EmulatorCore& core_;
  std::vector<std::weak_ptr<Connection>> connections_;
  const std::shared_ptr<int> alive_ = std::make_shared<int>();
};

}  // namespace glint::emulator
