// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "daemon/config.hpp"
#include "driver/core/time.hpp"

/// The protocol's grammar: lines to requests, values to lines. Pure functions; PROTOCOL.md says
/// what it all means.
namespace glint::daemon {

/// Longest line in either direction, with its LF.
constexpr std::size_t kMaxLineBytes = 1 << 20;
/// Deepest nesting of a request.
constexpr int kMaxDepth = 16;

// JSON-RPC's own error codes.
constexpr int kParseError = -32700;
constexpr int kInvalidRequest = -32600;
constexpr int kMethodNotFound = -32601;
constexpr int kInvalidParams = -32602;
constexpr int kInternalError = -32603;
// This server's; `data.code` names them.
constexpr int kNotTracking = -32001;
constexpr int kTooLarge = -32002;
constexpr int kBusy = -32003;
constexpr int kForbidden = -32004;
constexpr int kNoSuchMap = -32005;
constexpr int kOutOfRange = -32006;
constexpr int kNotConfigured = -32007;

/// An answer that is an error. Thrown by handlers, sent to the client.
class RpcError : public std::runtime_error {
 public:
  /// `field`: the parameter that is wrong; empty if none. `data`: more for programs, an object.
  RpcError(int code, const std::string& message, std::string field = {},
           Json data = Json::object());
  /// The `error` member of the reply.
  [[nodiscard]] Json to_json() const;
  [[nodiscard]] int code() const { return code_; }

 private:
  int code_;
  std::string field_;
  Json data_;
};

/// A request, or a notification when it has no id (it gets no reply). Value type.
struct Request {
  bool has_id = false;
  Json id;
  std::string method;
  Json params = Json::object();
};

/// What a line was: a request, or the error to send with the id it had, as far as it could be read.
struct BadRequest {
  Json id;  ///< Null when unknown.
  RpcError error;
};
std::variant<Request, BadRequest> parse_request(std::string_view line);
/// The error of what is no JSON at all.
RpcError not_json();

// Lines to send, with their LF.
std::string result_line(const Json& id, const Json& result);
std::string error_line(const Json& id, const RpcError& error);
std::string notification_line(std::string_view method, const Json& params);
/// The same of params that are text already, an object with members; its number and how many were
/// missed come in.
std::string numbered_notification_line(std::string_view method, std::string_view params,
                                       std::uint64_t seq, std::uint64_t missed);

/// "sec.nnnnnnnnn".
std::string time_string(std::int64_t ns);
/// Puts a time in as `t_ns` (exact integer) and `t` (string).
void put_time(Json& out, SensorTime time);

// Parameters of a request. Each throws RpcError(kInvalidParams) naming the field.
/// Null when absent.
const Json* find_param(const Json& params, const char* name);
double number_param(const Json& params, const char* name, double absent, double min, double max);
/// One of `choices` ("a|b"); the first one when absent.
std::string choice_param(const Json& params, const char* name, std::string_view choices);
/// A time: an integer of nanoseconds or a string "sec.nnnnnnnnn", under `NAME_ns` or `NAME`.
std::optional<SensorTime> time_param(const Json& params, const std::string& name);

}  // namespace glint::daemon
