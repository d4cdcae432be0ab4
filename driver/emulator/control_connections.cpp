// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/control_connections.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace glint::emulator {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMaxRequestBytes = 1U << 16U;

std::string address_of(const tcp::socket& socket) {
  error_code error;
  const tcp::endpoint remote = socket.remote_endpoint(error);
  return error ? std::string() : remote.address().to_string();
}

}  // namespace

HttpConnection::HttpConnection(tcp::socket socket, EmulatorCore& core)
    : socket_(std::move(socket)), core_(core), buffer_(kMaxRequestBytes) {}

void HttpConnection::start() {
  http::async_read(socket_, buffer_, request_,
                   [self = shared_from_this()](error_code error, std::size_t) {
                     if (!error && !self->closed_) self->reply();
                   });
}

void HttpConnection::close() {
  closed_ = true;
  error_code ignored;
  socket_.close(ignored);
}

void HttpConnection::reply() {
  const std::string method(request_.method_string());
  const std::string target(request_.target());
  const auto fault = core_.next_fault(target);
  if (fault == ControlFault::kSlow) {
    wait_for_the_end();
  } else if (fault == ControlFault::kServerError) {
    send({500, "emulated fault"}, fault);
  } else {
    send(core_.answer({method, target, request_.body(), address_of(socket_)}), fault);
  }
}

void HttpConnection::send(const EmulatedAnswer& answer, std::optional<ControlFault> fault) {
  if (closed_) return;  // Whoever sends the packets may have cut its power.
  const std::string body =
      fault == ControlFault::kNoJson ? "<html>emulated fault</html>" : answer.body;
  bytes_ = fmt::format(
      "HTTP/1.1 {} Emulated\r\nContent-Type: application/json\r\nContent-Length: {}\r\n"
      "Connection: close\r\n\r\n{}",
      answer.status, body.size(), body);
  if (fault == ControlFault::kGarbage) bytes_ = "\x01\x02 emulated fault\r\n\r\n";
  if (fault == ControlFault::kHalfAnswer) bytes_.resize(bytes_.size() - body.size() / 2);
  asio::async_write(socket_, asio::buffer(bytes_),
                    [self = shared_from_this()](error_code, std::size_t) { self->close(); });
}

/// Until the client loses patience.
void HttpConnection::wait_for_the_end() {
  socket_.async_wait(tcp::socket::wait_read,
                     [self = shared_from_this()](error_code) { self->close(); });
}

LineConnection::LineConnection(tcp::socket socket, EmulatorCore& core)
    : socket_(std::move(socket)), core_(core) {}

void LineConnection::start() {
  asio::async_read_until(socket_, asio::dynamic_buffer(input_, kMaxRequestBytes), '\n',
                         [self = shared_from_this()](error_code error, std::size_t bytes) {
                           if (!error && !self->closed_) self->reply(bytes);
                         });
}

void LineConnection::close() {
  closed_ = true;
  error_code ignored;
  socket_.close(ignored);
}

void LineConnection::reply(std::size_t bytes) {
  std::string line = input_.substr(0, bytes - 1);
  if (line.ends_with('\r')) line.pop_back();
  input_.erase(0, bytes);
  output_ = core_.answer_line(line, address_of(socket_)) + "\n";
  asio::async_write(socket_, asio::buffer(output_),
                    [self = shared_from_this()](error_code error, std::size_t) {
                      if (!error && !self->closed_) self->start();
                    });
}

}  // namespace glint::emulator
