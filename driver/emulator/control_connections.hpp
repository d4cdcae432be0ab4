// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cstddef>
#include <memory>
#include <string>

#include "driver/emulator/emulator_core.hpp"

namespace glint::emulator {

/// One HTTP request to the emulated sensor and its answer. Keeps itself until that is done; the
/// core must outlive it or it must have been closed. Thread-compatible.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(boost::asio::ip::tcp::socket socket, EmulatorCore& core);
  void start();
  void close();

 private:
  void reply();
  void send(const EmulatedAnswer& answer, std::optional<ControlFault> fault);
  void wait_for_the_end();

  boost::asio::ip::tcp::socket socket_;
  EmulatorCore& core_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request<boost::beast::http::string_body> request_;
  std::string bytes_;
  bool closed_ = false;
};

/// A client of the emulated sensor's text commands, one line after another. As above.
class LineConnection : public std::enable_shared_from_this<LineConnection> {
 public:
  LineConnection(boost::asio::ip::tcp::socket socket, EmulatorCore& core);
  void start();
  void close();

 private:
  void reply(std::size_t bytes);

  boost::asio::ip::tcp::socket socket_;
  EmulatorCore& core_;
  std::string input_;
  std::string output_;
  bool closed_ = false;
};

}  // namespace glint::emulator
