// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/steady_clock.hpp"

namespace glint::daemon {
namespace {

/// How long a client that was sent away may take to notice.
constexpr std::int64_t kFarewellNs = 2'000'000'000;
constexpr std::int64_t kHandshakeNs = 5'000'000'000;
/// How long a client may take to send its token.
constexpr std::int64_t kTokenNs = 10'000'000'000;
/// A wrong token is answered so late, and so many of them end the connection.
constexpr std::int64_t kWrongTokenNs = 1'000'000'000;
constexpr int kMostWrongTokens = 3;
/// Longest line from a client that has not shown a token.
constexpr std::size_t kLongestTokenLine = 4096;

Json rights_json(Right right) {
  Json rights = Json::array();
  if (right >= Right::kRead) rights.push_back("read");
  if (right >= Right::kControl) rights.push_back("control");
  return rights;
}

}  // namespace

using boost::system::error_code;

Session::Session(std::unique_ptr<Connection> connection, const SessionContext& context, Right right,
                 OnClosed on_closed)
    : context_(context),
      on_closed_(std::move(on_closed)),
      connection_(std::move(connection)),
      begin_ns_(steady_now_ns()),
      subscriptions_(context_.api, context_.counters,
                     [this] {
                       const auto self = shared_from_this();
                       write();
                     }),
      budget_(context_.limits.requests_per_s, begin_ns_),
      right_(right),
      last_request_ns_(begin_ns_),
      last_progress_ns_(begin_ns_) {}

void Session::start() {
  connection_->open([self = shared_from_this()](error_code error) { self->opened(error); });
}

void Session::opened(error_code error) {
  if (closed_) return;
  if (error) return close_because(context_.counters.failed_handshakes);
  open_ = true;
  send(context_.api.hello_line(owes_token()));
  read();
}

void Session::read() {
  if (reading_ || closed_ || awaiting_reply_ || throttled_) return;
  reading_ = true;
  connection_->read_some(boost::asio::buffer(chunk_),
                         [self = shared_from_this()](error_code error, std::size_t size) {
                           self->reading_ = false;
                           if (error) return self->close();
                           self->take_input(size);
                         });
}

void Session::take_input(std::size_t size) {
  // What comes from a client that is being sent away is read, or the kernel would answer it with a
  // reset that overtakes the error message.
  if (!closing_) {
    input_.append(chunk_.data(), size);
    if (first_line_) refuse_other_protocol();
    take_lines();
  }
  read();
}

// Some protocols never send a line feed: their first byte tells.
void Session::refuse_other_protocol() {
  const auto first = input_.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || input_[first] == '{' || input_[first] == '[') return;
  ++context_.counters.junk_clients;
  refuse(not_json());
}

std::size_t Session::longest_line() const {
  return owes_token() ? kLongestTokenLine : kMaxLineBytes;
}

void Session::take_lines() {
  std::size_t begin = 0;
  while (!closed_ && !closing_ && !awaiting_reply_) {
    const auto end = input_.find('\n', begin);
    const std::size_t length = std::min(end, input_.size()) - begin;
    if (length >= longest_line()) {
      ++context_.counters.junk_clients;
      refuse(RpcError(kTooLarge,
                      fmt::format("the line is longer than the {} bytes allowed{}", longest_line(),
                                  owes_token() ? " before authenticate" : "")));
    }
    if (closing_ || end == std::string::npos) break;
    throttled_ = !budget_.take(steady_now_ns());
    if (throttled_) {
      ++context_.counters.throttled_requests;
      break;
    }
    std::string_view line(input_.data() + begin, length);
    begin = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.empty()) take_line(line);
  }
  input_.erase(0, begin);
}

void Session::take_line(std::string_view line) {
  last_request_ns_ = steady_now_ns();
  const auto parsed = parse_request(line);
  const bool first = std::exchange(first_line_, false);
  if (const auto* bad = std::get_if<BadRequest>(&parsed)) {
    ++context_.counters.bad_requests;
    // Another protocol's client: one error tells it, more would only keep it talking.
    if (first && bad->error.code() == kParseError) {
      ++context_.counters.junk_clients;
      return refuse(bad->error);
    }
    return send(error_line(bad->id, bad->error));
  }
  ++context_.counters.requests;
  answer(std::get<Request>(parsed));
}

void Session::answer(const Request& request) {
  if (!request.has_id) return;
  answering_ = true;
  try {
    dispatch(request);
  } catch (const RpcError& error) {
    awaiting_reply_ = false;
    send(error_line(request.id, error));
  } catch (const std::exception& error) {
    awaiting_reply_ = false;
    send(error_line(request.id, RpcError(kInternalError, error.what())));
  }
  answering_ = false;
}

void Session::dispatch(const Request& request) {
  if (request.method == "authenticate") return authenticate(request);
  expect_right(request.method);
  if (request.method == "subscribe") {
    send(result_line(request.id, subscriptions_.subscribe(request.params)));
  } else if (request.method == "unsubscribe") {
    send(result_line(request.id, subscriptions_.unsubscribe(request.params)));
  } else {
    awaiting_reply_ = true;
    context_.api.call(request, [weak = weak_from_this()](std::string line) {
      if (const auto self = weak.lock()) self->take_reply(std::move(line));
    });
  }
}

// Where none is asked any token will do: a client may send its own everywhere.
void Session::authenticate(const Request& request) {
  const Json* token = find_param(request.params, "token");
  if (token == nullptr || !token->is_string()) {
    throw RpcError(kInvalidParams, "token must be a string", "token");
  }
  const Right given = context_.access.right_of(token->get_ref<const std::string&>());
  if (given == Right::kNone && right_ != Right::kControl) return refuse_token(request.id);
  lives_by_token_ = lives_by_token_ || given > right_;
  right_ = std::max(right_, given);
  Json result = context_.api.head();
  result["rights"] = rights_json(right_);
  send(result_line(request.id, result));
}

// The answer comes late, and nothing else is taken before it: trying takes time.
void Session::refuse_token(const Json& id) {
  ++context_.counters.failed_authentications;
  ++failed_tokens_;
  refusal_ = error_line(id, RpcError(kForbidden, "the token is not known to this server", "token"));
  refusal_due_ns_ = steady_now_ns() + kWrongTokenNs;
  awaiting_reply_ = true;
}

void Session::expect_right(const std::string& method) {
  const Right needed = needed_right(method);
  if (right_ >= needed) return;
  ++context_.counters.forbidden_requests;
  if (owes_token()) {
    throw RpcError(kForbidden, "this server asks for a token: call authenticate {token} first");
  }
  throw RpcError(kForbidden, fmt::format("{} needs the right {}, and this client's token gives {}",
                                         method, to_string(needed), to_string(right_)));
}

void Session::take_reply(std::string line) {
  awaiting_reply_ = false;
  send(std::move(line));
  if (failed_tokens_ >= kMostWrongTokens) closing_ = true;
  // A late reply, from the worker: lines may have piled up behind the request.
  if (!answering_) take_input(0);
}

void Session::refuse(const RpcError& error) {
  send(error_line(nullptr, error));
  closing_ = true;
  write();
}

void Session::send(std::string line) {
  if (closed_ || closing_) return;
  if (outbox_size_ + line.size() > context_.limits.outbox_bytes) {
    return close_because(context_.counters.slow_clients);
  }
  outbox_size_ += line.size();
  outbox_.push_back(std::move(line));
  write();
}

void Session::write() {
  if (closed_ || hung_up_ || !open_ || !writing_.empty()) return;
  if (!outbox_.empty()) {
    writing_ = std::move(outbox_.front());
    outbox_.pop_front();
    outbox_size_ -= writing_.size();
  } else if (closing_) {
    return hang_up();
  } else if (auto line = subscriptions_.next_line()) {
    writing_ = std::move(*line);
  } else {
    return;
  }
  written_ = 0;
  last_progress_ns_ = steady_now_ns();
  write_rest();
}

void Session::write_rest() {
  connection_->write_some(boost::asio::buffer(writing_) + written_,
                          [self = shared_from_this()](error_code error, std::size_t size) {
                            if (error) return self->close();
                            self->written_ += size;
                            self->last_progress_ns_ = steady_now_ns();
                            if (self->written_ < self->writing_.size()) return self->write_rest();
                            self->writing_.clear();
                            self->write();
                          });
}

void Session::hang_up() {
  hung_up_ = true;
  last_progress_ns_ = steady_now_ns();
  error_code ignored;
  connection_->socket().shutdown(Connection::Socket::shutdown_send, ignored);
}

void Session::offer(const std::shared_ptr<const Snapshot>& snapshot) {
  if (closing_) return;
  subscriptions_.offer(snapshot);
  write();
}

void Session::tick(std::int64_t now_ns) {
  subscriptions_.tick(now_ns);
  if (!refusal_.empty() && now_ns >= refusal_due_ns_) take_reply(std::exchange(refusal_, {}));
  if (std::exchange(throttled_, false)) take_input(0);
  write();
  look_at_limits(now_ns);
}

void Session::look_at_limits(std::int64_t now_ns) {
  const bool idle = subscriptions_.empty() && !awaiting_reply_ && !throttled_ &&
                    now_ns - last_request_ns_ > context_.limits.idle_ns;
  const bool tokenless = owes_token() && now_ns - begin_ns_ > kTokenNs;
  const bool stalled = !writing_.empty() && now_ns - last_progress_ns_ > context_.limits.stall_ns;
  const bool gone = hung_up_ && now_ns - last_progress_ns_ > kFarewellNs;
  if (!open_ && now_ns - begin_ns_ > kHandshakeNs) {
    return close_because(context_.counters.failed_handshakes);
  }
  if (idle || tokenless) return close_because(context_.counters.idle_clients);
  if (stalled) return close_because(context_.counters.slow_clients);
  if (gone) close();
}

void Session::close_because(std::uint64_t& counter) {
  if (!closed_) ++counter;
  close();
}

void Session::close() {
  if (closed_) return;
  closed_ = true;
  error_code ignored;
  connection_->socket().shutdown(Connection::Socket::shutdown_both, ignored);
  connection_->socket().close(ignored);
  on_closed_(shared_from_this());
}

}  // namespace glint::daemon
