// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <boost/asio/generic/stream_protocol.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "daemon/api.hpp"
#include "daemon/subscriptions.hpp"

namespace glint::daemon {

/// What a connection may cost.
struct SessionLimits {
  std::size_t outbox_bytes = 8 << 20;
  std::int64_t idle_ns = 900'000'000'000;
  std::int64_t stall_ns = 180'000'000'000;
};

/// One client's connection: lines in, replies and notifications out. Replies keep the order of the
/// requests; a request that the worker answers holds back those behind it. Lives on the main
/// thread.
class Session : public std::enable_shared_from_this<Session> {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  /// Called once, when the connection is over.
  using OnClosed = std::function<void(const std::shared_ptr<Session>&)>;

  Session(Socket socket, Api& api, SessionLimits limits, OnClosed on_closed);

  /// Sends hello and begins to read.
  void start();
  void offer(const std::shared_ptr<const Snapshot>& snapshot);
  /// Due notifications and time-outs; `now_ns`: steady clock.
  void tick(std::int64_t now_ns);
  void close();

 private:
  void read();
  void take_input(std::size_t size);
  void take_lines();
  void take_line(std::string_view line);
  void answer(const Request& request);
  void take_reply(std::string line);
  /// An error that ends the connection once it is sent.
  void refuse(const RpcError& error);
  void send(std::string line);
  void write();
  void write_rest();
  /// Everything is said: tells the client so, and waits for it to hang up.
  void hang_up();

  Api& api_;
  const SessionLimits limits_;
  const OnClosed on_closed_;
  Socket socket_;
  Subscriptions subscriptions_;

  std::array<char, 16384> chunk_{};
  std::string input_;  ///< Received, not yet taken.
  bool reading_ = false;
  bool first_line_ = true;
  bool answering_ = false;       ///< Inside answer().
  bool awaiting_reply_ = false;  ///< A request has not been answered yet.

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
