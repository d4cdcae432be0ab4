// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/exchange.hpp"

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "driver/session/sensor_json.hpp"

namespace glint {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

/// A link-local address as others on the link write it: the interface's name is ours only.
asio::ip::address without_scope(const asio::ip::address& address) {
  if (!address.is_v6()) return address;
  asio::ip::address_v6 v6 = address.to_v6();
  v6.scope_id(0);
  return v6;
}

/// Looks the host up and connects; what is said then is for the two kinds below.
class Connection : public Exchange, public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::io_context& io, ExchangeTarget target, SensorRequest request,
             ExchangeHandler handler)
      : target_(std::move(target)),
        request_(std::move(request)),
        resolver_(io),
        socket_(io),
        deadline_(io),
        handler_(std::move(handler)) {}

  void start() {
    deadline_.expires_after(target_.timeout);
    deadline_.async_wait([self = shared_from_this()](error_code error) {
      if (!error) self->fail_by_timeout();
    });
    error_code not_numeric;
    const auto address = asio::ip::make_address(target_.host, not_numeric);
    if (!not_numeric) {
      connect({tcp::endpoint(address, target_.port)});
      return;
    }
    resolver_.async_resolve(
        target_.host, std::to_string(target_.port),
        [self = shared_from_this()](error_code error, const tcp::resolver::results_type& results) {
          self->on_resolved(error, results);
        });
  }

  void cancel() override {
    handler_ = nullptr;
    close();
  }

 protected:
  /// Called once when connected.
  virtual void talk() = 0;

  /// A broken connection in the sensor's own terms. True when there was none.
  bool check(error_code error) {
    if (!handler_) return false;
    if (!error) return true;
    fail(fmt::format("{} broke off the answer to {} ({}); if it stays so, restart the sensor",
                     target_.host, name_of(request_), error.message()));
    return false;
  }

  void fail(std::string sentence) {
    reply_.failure = std::move(sentence);
    finish();
  }

  void finish() {
    close();
    if (handler_) std::exchange(handler_, nullptr)(std::move(reply_));
  }

  const ExchangeTarget target_;
  const SensorRequest request_;
  tcp::resolver resolver_;
  tcp::socket socket_;
  asio::steady_timer deadline_;
  ExchangeReply reply_;

 private:
  void on_resolved(error_code error, const tcp::resolver::results_type& results) {
    if (!handler_) return;
    if (error) {
      fail(
          fmt::format("{} is no name known here ({}); check sensor.host, or use the sensor's IP "
                      "address (names in .local need mDNS, e.g. libnss-mdns)",
                      target_.host, error.message()));
      return;
    }
    std::vector<tcp::endpoint> endpoints;
    for (const auto& entry : results) endpoints.push_back(entry.endpoint());
    connect(std::move(endpoints));
  }

  void connect(std::vector<tcp::endpoint> endpoints) {
    endpoints_ = std::move(endpoints);
    asio::async_connect(socket_, endpoints_,
                        [self = shared_from_this()](error_code error, const tcp::endpoint&) {
                          self->on_connected(error);
                        });
  }

  void on_connected(error_code error) {
    if (!handler_) return;
    if (error == asio::error::connection_refused) {
      fail(
          fmt::format("{} refuses connections on port {}; it is still starting, or it is no Ouster "
                      "sensor: check sensor.host",
                      target_.host, target_.port));
      return;
    }
    if (error) {
      fail(
          fmt::format("{} cannot be reached on port {} ({}); check its power, the cable, and that "
                      "this machine has an address in its network",
                      target_.host, target_.port, error.message()));
      return;
    }
    error_code ignored;
    const tcp::endpoint local = socket_.local_endpoint(ignored);
    if (!ignored) reply_.local_address = without_scope(local.address()).to_string();
    const tcp::endpoint peer = socket_.remote_endpoint(ignored);
    if (!ignored) reply_.peer_address = without_scope(peer.address()).to_string();
    talk();
  }

  void fail_by_timeout() {
    if (!handler_) return;
    fail(fmt::format(
        "{} did not answer {} within {:.3g} s; check its power, the cable, and that "
        "this machine has an address in its network",
        target_.host, name_of(request_), static_cast<double>(target_.timeout.count()) * 1e-3));
  }

  void close() {
    error_code ignored;
    resolver_.cancel();
    deadline_.cancel(ignored);
    socket_.close(ignored);
  }

  ExchangeHandler handler_;
  std::vector<tcp::endpoint> endpoints_;
};

/// What came cannot be read as HTTP.
bool is_http_error(error_code error) {
  return error && error.category() == http::make_error_code(http::error::bad_version).category();
}

class HttpExchange final : public Connection {
 public:
  using Connection::Connection;

 private:
  std::shared_ptr<HttpExchange> self() {
    return std::static_pointer_cast<HttpExchange>(shared_from_this());
  }

  void talk() override {
    message_.method_string(request_.method);
    message_.target(request_.target);
    message_.version(11);
    message_.set(http::field::host, target_.host);
    message_.set(http::field::accept, "application/json");
    message_.set(http::field::connection, "close");
    if (!request_.body.empty()) message_.set(http::field::content_type, "application/json");
    message_.body() = request_.body;
    message_.prepare_payload();
    parser_.body_limit(kMaxReplyBytes);
    http::async_write(socket_, message_, [me = self()](error_code error, std::size_t) {
      if (me->check(error)) me->listen();
    });
  }

  void listen() {
    http::async_read(socket_, buffer_, parser_,
                     [me = self()](error_code error, std::size_t) { me->on_answer(error); });
  }

  void on_answer(error_code error) {
    const bool cut_off =
        error == http::error::end_of_stream || error == http::error::partial_message;
    if (error == http::error::body_limit) {
      fail(
          fmt::format("{} answers {} with more than {} bytes; it is no Ouster sensor: check "
                      "sensor.host",
                      target_.host, name_of(request_), kMaxReplyBytes));
      return;
    }
    if (!cut_off && is_http_error(error)) {
      fail(
          fmt::format("{} answers {} with something that is not HTTP ({}); it is no Ouster sensor: "
                      "check sensor.host",
                      target_.host, name_of(request_), error.message()));
      return;
    }
    if (!check(error)) return;
    reply_.status = static_cast<int>(parser_.get().result_int());
    reply_.body = std::move(parser_.get().body());
    finish();
  }

  http::request<http::string_body> message_;
  http::response_parser<http::string_body> parser_;
  boost::beast::flat_buffer buffer_{kMaxReplyBytes};
};

class LineExchange final : public Connection {
 public:
  using Connection::Connection;

 private:
  std::shared_ptr<LineExchange> self() {
    return std::static_pointer_cast<LineExchange>(shared_from_this());
  }

  void talk() override {
    line_ = request_.target + "\n";
    asio::async_write(socket_, asio::buffer(line_), [me = self()](error_code error, std::size_t) {
      if (me->check(error)) me->listen();
    });
  }

  void listen() {
    asio::async_read_until(socket_, asio::dynamic_buffer(reply_.body, kMaxReplyBytes), '\n',
                           [me = self()](error_code error, std::size_t bytes) {
                             if (error == asio::error::not_found) {
                               me->fail(fmt::format(
                                   "{} answers {} with a line of more than {} bytes; it is no "
                                   "Ouster sensor: check sensor.host",
                                   me->target_.host, name_of(me->request_), kMaxReplyBytes));
                               return;
                             }
                             if (!me->check(error)) return;
                             me->reply_.body.resize(bytes - 1);
                             if (me->reply_.body.ends_with('\r')) me->reply_.body.pop_back();
                             me->finish();
                           });
  }

  std::string line_;
};

}  // namespace

std::shared_ptr<Exchange> start_exchange(asio::io_context& io, const ExchangeTarget& target,
                                         const SensorRequest& request, ExchangeHandler handler) {
  std::shared_ptr<Connection> connection;
  if (request.method.empty()) {
    connection = std::make_shared<LineExchange>(io, target, request, std::move(handler));
  } else {
    connection = std::make_shared<HttpExchange>(io, target, request, std::move(handler));
  }
  connection->start();
  return connection;
}

}  // namespace glint
