// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/access.hpp"
#include "daemon/api.hpp"
#include "daemon/connection.hpp"
#include "daemon/request_budget.hpp"
#include "daemon/server_counters.hpp"
#include "daemon/subscriptions.hpp"

namespace glint::daemon {

/// What a connection may cost.
struct SessionLimits {
  std::size_t outbox_bytes = 8 << 20;
  std::int64_t idle_ns = 900'000'000'000;
  std::int64_t stall_ns = 180'000'000'000;
  double requests_per_s = 1000.0;
};

/// What all sessions share; outlives them.
struct SessionContext {
  Api& api;
  const Access& access;
  const SessionLimits limits;
  ServerCounters& counters;
};

/// One client's connection: lines in, replies and notifications out. Replies keep the order of the
/// requests; a request that the worker answers, or that comes faster than the client may ask, holds
/// back those behind it. Lives on the main thread.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// Called once, when the connection is over.
  using OnClosed = std::function<void(const std::shared_ptr<Session>&)>;

  /// `right`: what the client may do without a token; kNone: it has to authenticate.
  Session(std::unique_ptr<Connection> connection, const SessionContext& context, Right right,
          OnClosed on_closed);

  /// Opens the connection, then sends hello and begins to read.
  void start();
  /// Whether the client still owes a token.
  [[nodiscard]] bool owes_token() const { return right_ == Right::kNone; }
  /// Whether a token gave the client a right that it would not have else.
  [[nodiscard]] bool lives_by_token() const { return lives_by_token_; }
  void offer(const std::shared_ptr<const Snapshot>& snapshot);
  /// Due notifications and time-outs; `now_ns`: steady clock.
  void tick(std::int64_t now_ns);
  void close();

 private:
  void opened(boost::system::error_code error);
  void read();
  void refuse_other_protocol();
  void take_input(std::size_t size);
  void take_lines();
  void take_line(std::string_view line);
  void answer(const Request& request);
  void dispatch(const Request& request);
  void authenticate(const Request& request);
  void refuse_token(const Json& id);
  void expect_right(const std::string& method);
  [[nodiscard]] std::size_t longest_line() const;
  void take_reply(std::string line);
  /// An error that ends the connection once it is sent.
  void refuse(const RpcError& error);
  void send(std::string line);
  void write();
  void write_rest();
  /// Everything is said: tells the client so, and waits for it to hang up.
  void hang_up();
  void look_at_limits(std::int64_t now_ns);
  void close_because(std::uint64_t& counter);

  const SessionContext context_;
  const OnClosed on_closed_;
  const std::unique_ptr<Connection> connection_;
  const std::int64_t begin_ns_;
  Subscriptions subscriptions_;
  RequestBudget budget_;
  Right right_;
  bool lives_by_token_ = false;

  std::array<char, 16384> chunk_{};
  std::string input_;  ///< Received, not yet taken.
  bool open_ = false;
  bool reading_ = false;
  bool throttled_ = false;  ///< The next line waits for the budget.
  bool first_line_ = true;
  bool answering_ = false;       ///< Inside answer().
  bool awaiting_reply_ = false;  ///< A request has not been answered yet.

  int failed_tokens_ = 0;
  std::string refusal_;  ///< Of a wrong token, sent at refusal_due_ns_; empty: there is none.
  std::int64_t refusal_due_ns_ = 0;

  std::deque<std::string> outbox_;
  std::size_t outbox_size_ = 0;  ///< Bytes in outbox_.
  std::string writing_;          ///< Being sent; empty when nothing is.
  std::size_t written_ = 0;      ///< Bytes of writing_ that are out.
  bool closing_ = false;         ///< Nothing more is taken or said; hang up when all is sent.
  bool hung_up_ = false;
  bool closed_ = false;
  std::int64_t last_request_ns_;
  std::int64_t last_progress_ns_;
};

}  // namespace glint::daemon
