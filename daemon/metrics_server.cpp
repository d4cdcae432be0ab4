// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/metrics_server.hpp"

#include <fmt/format.h>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <utility>

#include "daemon/listener.hpp"

namespace glint::daemon {
namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr const char* kMetricsKey = "metrics.listen";
/// Asking and being answered may take so long.
constexpr std::chrono::seconds kExchangeTime{5};
constexpr std::chrono::seconds kAcceptRetry{1};
constexpr std::uint32_t kMostHeaderBytes = 8192;
/// Connections at a time; those who watch are few.
constexpr int kMostConnections = 16;
constexpr const char* kPlainText = "text/plain; charset=utf-8";

}  // namespace

/// One connection: a request, its answer, and the end.
class MetricsServer::Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(tcp::socket socket, MetricsServer& server)
      : stream_(std::move(socket)), server_(server) {
    ++server_.open_;
    parser_.header_limit(kMostHeaderBytes);
    parser_.body_limit(0);
  }
  ~Exchange() { --server_.open_; }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  void start() {
    stream_.expires_after(kExchangeTime);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) return self->respond();
                       ++self->server_.counters_.refused_scrapes;
                     });
  }

 private:
  void respond() {
    ++server_.counters_.scrapes;
    response_.version(parser_.get().version());
    response_.set(http::field::content_type, kPlainText);
    response_.keep_alive(false);
    response_.result(http::status::ok);
    choose_body();
    if (response_.result() == http::status::ok && parser_.get().method() == http::verb::head) {
      const std::size_t size = response_.body().size();
      response_.body().clear();
      response_.content_length(size);
    } else {
      response_.prepare_payload();
    }
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  void choose_body() {
    const auto method = parser_.get().method();
    if (method != http::verb::get && method != http::verb::head) {
      response_.set(http::field::allow, "GET, HEAD");
      return say(http::status::method_not_allowed, "only GET and HEAD are answered\n");
    }
    const std::string target(parser_.get().target());
    const std::string path = target.substr(0, target.find('?'));
    if (path == "/metrics") return tell_metrics();
    if (path == "/healthz") {
      const std::string problem = server_.api_.health_problem();
      return problem.empty() ? say(http::status::ok, "ok\n") : unavailable(problem);
    }
    if (path == "/readyz") {
      const auto state = server_.api_.head()["state"].get<std::string>();
      const bool is_ready = state == "TRACKING" || state == "DEGRADED";
      return is_ready ? say(http::status::ok, state + "\n") : unavailable(state);
    }
    say(http::status::not_found, "there are /metrics, /healthz and /readyz\n");
  }

  void tell_metrics() {
    if (!may_read()) {
      ++server_.counters_.failed_authentications;
      response_.set(http::field::www_authenticate, "Bearer");
      return say(http::status::unauthorized, "a token is needed: Authorization: Bearer TOKEN\n");
    }
    response_.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
    response_.body() = server_.api_.metrics();
  }

  [[nodiscard]] bool may_read() const {
    if (!server_.asks_token_) return true;
    constexpr std::string_view kBearer = "Bearer ";
    const auto header = parser_.get()[http::field::authorization];
    const std::string_view value(header.data(), header.size());
    return value.starts_with(kBearer) &&
           server_.access_.right_of(value.substr(kBearer.size())) >= Right::kRead;
  }

  void unavailable(const std::string& why) { say(http::status::service_unavailable, why + "\n"); }
  void say(http::status status, const std::string& text) {
    response_.result(status);
    response_.body() = text;
  }

  boost::beast::tcp_stream stream_;
  MetricsServer& server_;
  boost::beast::flat_buffer buffer_{kMostHeaderBytes};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

MetricsServer::MetricsServer(boost::asio::io_context& io, const Api& api, const Access& access,
                             ServerCounters& counters, const std::string& listen)
    : api_(api), access_(access), counters_(counters), acceptor_(io) {
  const tcp::endpoint endpoint = resolve_listen(io, listen, kMetricsKey);
  const bool is_local = endpoint.address().is_loopback();
  if (!is_local && !access_.has_tokens()) {
    throw ConfigError(
        fmt::format("{} = \"{}\" can be reached by other machines, which needs a token: name a "
                    "file with one in "
                    "server.read_token_file, or listen on 127.0.0.1",
                    kMetricsKey, listen));
  }
  asks_token_ = !is_local || access_.is_required();
  listen_at(acceptor_, endpoint, kMetricsKey);
}

void MetricsServer::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (!error && open_ < kMostConnections) {
      std::make_shared<Exchange>(std::move(socket), *this)->start();
    } else if (!error) {
      ++counters_.refused_scrapes;
    } else {
      // Out of file descriptors or the like: it passes, and a retry at once would spin.
      auto pause =
          std::make_shared<boost::asio::steady_timer>(acceptor_.get_executor(), kAcceptRetry);
      return pause->async_wait([this, pause](error_code) {
        if (acceptor_.is_open()) accept();
      });
    }
    accept();
  });
}

void MetricsServer::close() {
  error_code ignored;
  acceptor_.close(ignored);
}

std::uint16_t MetricsServer::port() const {
  error_code error;
  const auto endpoint = acceptor_.local_endpoint(error);
  return error ? std::uint16_t{0} : endpoint.port();
}

}  // namespace glint::daemon
