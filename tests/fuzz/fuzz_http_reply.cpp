// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What a sensor answers over HTTP or its TCP port, down to the last byte: over a real connection.
#include <fmt/format.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "driver/session/exchange.hpp"
#include "driver/session/sensor_json.hpp"
#include "tests/fuzz/require.hpp"

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// Answers a connection with the given bytes, then says no more.
class Server {
 public:
  Server() : acceptor_(io_, tcp::endpoint(tcp::v4(), 0)) {}

  asio::io_context& io() { return io_; }
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  void answer(std::string_view bytes) {
    acceptor_.async_accept([this, bytes](boost::system::error_code error, tcp::socket socket) {
      if (error) return;
      peer_.emplace(std::move(socket));
      asio::async_write(*peer_, asio::buffer(bytes),
                        [this](boost::system::error_code, std::size_t) {
                          boost::system::error_code ignored;
                          peer_->shutdown(tcp::socket::shutdown_send, ignored);
                        });
    });
  }
  void hang_up() {
    boost::system::error_code ignored;
    acceptor_.cancel(ignored);
    peer_.reset();
  }

 private:
  asio::io_context io_;
  tcp::acceptor acceptor_;
  std::optional<tcp::socket> peer_;
};

/// Another of this machine's addresses each time, so that ports do not run out.
std::string next_host() {
  static std::uint32_t count = 0;
  count = count % 60'000 + 1;
  return fmt::format("127.1.{}.{}", count / 250, count % 250 + 1);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static Server server;
  const bool over_http = (data[0] & 1U) != 0;
  const glint::SensorRequest request{over_http ? "GET" : "",
                                     over_http ? "/api/v1/sensor/metadata" : "get_sensor_info",
                                     {},
                                     {},
                                     {}};
  int answers = 0;
  server.answer(glint::fuzz::as_text(data + 1, size - 1));
  const auto exchange = glint::start_exchange(
      server.io(), {next_host(), server.port(), std::chrono::milliseconds(5000)}, request,
      [&](const glint::ExchangeReply& reply) {
        ++answers;
        glint::fuzz::require(reply.body.size() <= glint::kMaxReplyBytes, "bodies are bounded");
        glint::fuzz::require(reply.failure.find('\n') == std::string::npos,
                             "a failure is one sentence");
        server.hang_up();
      });
  server.io().restart();
  server.io().run();
  glint::fuzz::require(answers == 1, "there is one answer");
  return 0;
}
