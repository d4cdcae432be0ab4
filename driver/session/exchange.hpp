// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "driver/session/api_form.hpp"

namespace glint {

/// Whom to ask, and how long to wait.
struct ExchangeTarget {
  std::string host;
  std::uint16_t port = 0;
  /// For everything from looking up the name to the last byte of the answer.
  std::chrono::milliseconds timeout{4000};
};

/// What came back.
struct ExchangeReply {
  int status = 0;             ///< HTTP status; 0 of a line.
  std::string body;           ///< Of any kind, at most kMaxReplyBytes.
  std::string local_address;  ///< This machine's end of the connection.
  std::string peer_address;   ///< The other end.
  std::string failure;        ///< One sentence; empty when there is an answer, whatever it says.
};

/// One connection for one question and its answer. Thread-compatible: used on the thread that runs
/// the io_context.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// Closes the connection; the handler will not be called.
  virtual void cancel() = 0;
};

using ExchangeHandler = std::function<void(ExchangeReply)>;

/// Asks over HTTP when the request has a method, else with a line of text. The handler is called
/// once, never from within this call.
std::shared_ptr<Exchange> start_exchange(boost::asio::io_context& io, const ExchangeTarget& target,
                                         const SensorRequest& request, ExchangeHandler handler);

}  // namespace glint
