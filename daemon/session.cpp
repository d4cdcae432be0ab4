// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <utility>

#include "daemon/steady_clock.hpp"

namespace glint::daemon {
namespace {

/// How long a client that was sent away may take to notice.
constexpr std::int64_t kFarewellNs = 2'000'000'000;

}  // namespace

using boost::system::error_code;

Session::Session(Socket socket, Api& api, SessionLimits limits, OnClosed on_closed)
    : api_(api),
      limits_(limits),
      on_closed_(std::move(on_closed)),
      socket_(std::move(socket)),
      subscriptions_(api),
      last_request_ns_(steady_now_ns()),
      last_progress_ns_(last_request_ns_) {}

void Session::start() {
  send(api_.hello_line());
  read();
}

void Session::read() {
  if (reading_ || closed_ || awaiting_reply_) return;
  reading_ = true;
  socket_.async_read_some(boost::asio::buffer(chunk_),
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
    take_lines();
  }
  read();
}

void Session::take_lines() {
  std::size_t begin = 0;
  while (!closed_ && !closing_ && !awaiting_reply_) {
    const auto end = input_.find('\n', begin);
    const std::size_t length = std::min(end, input_.size()) - begin;
    if (length >= kMaxLineBytes) {
      refuse(RpcError(kTooLarge, "the line is longer than the 1048576 bytes allowed"));
    }
    if (closing_ || end == std::string::npos) break;
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
    // Another protocol's client: one error tells it, more would only keep it talking.
    if (first && bad->error.code() == kParseError) return refuse(bad->error);
    return send(error_line(bad->id, bad->error));
  }
  answer(std::get<Request>(parsed));
}

void Session::answer(const Request& request) {
  if (!request.has_id) return;
  answering_ = true;
  try {
    if (request.method == "subscribe") {
      send(result_line(request.id, subscriptions_.subscribe(request.params)));
    } else if (request.method == "unsubscribe") {
      send(result_line(request.id, subscriptions_.unsubscribe(request.params)));
    } else {
      awaiting_reply_ = true;
      api_.call(request, [weak = weak_from_this()](std::string line) {
        if (const auto self = weak.lock()) self->take_reply(std::move(line));
      });
    }
  } catch (const RpcError& error) {
    awaiting_reply_ = false;
    send(error_line(request.id, error));
  } catch (const std::exception& error) {
    awaiting_reply_ = false;
    send(error_line(request.id, RpcError(kInternalError, error.what())));
  }
  answering_ = false;
}

void Session::take_reply(std::string line) {
  awaiting_reply_ = false;
  send(std::move(line));
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
  if (outbox_size_ + line.size() > limits_.outbox_bytes) return close();
  outbox_size_ += line.size();
  outbox_.push_back(std::move(line));
  write();
}

void Session::write() {
  if (closed_ || hung_up_ || !writing_.empty()) return;
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
  socket_.async_write_some(boost::asio::buffer(writing_) + written_,
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
  socket_.shutdown(Socket::shutdown_send, ignored);
}

void Session::offer(const std::shared_ptr<const Snapshot>& snapshot) {
  if (closing_) return;
  subscriptions_.offer(snapshot);
  write();
}

void Session::tick(std::int64_t now_ns) {
  subscriptions_.tick(now_ns);
  write();
  const bool idle = subscriptions_.empty() && now_ns - last_request_ns_ > limits_.idle_ns;
  const bool stalled = !writing_.empty() && now_ns - last_progress_ns_ > limits_.stall_ns;
  const bool gone = hung_up_ && now_ns - last_progress_ns_ > kFarewellNs;
  if (idle || stalled || gone) close();
}

void Session::close() {
  if (closed_) return;
  closed_ = true;
  error_code ignored;
  socket_.shutdown(Socket::shutdown_both, ignored);
  socket_.close(ignored);
  on_closed_(shared_from_this());
}

}  // namespace glint::daemon
